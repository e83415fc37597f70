// The page of a surface: puts its parts together.

import {App} from './app.js';

try {
  window.kreplView = new App().api();
} catch (error) {
  const failure = document.getElementById('failure');
  failure.hidden = false;
  failure.textContent = /webgl/i.test(error.message) ?
      'This page draws with WebGL 2, which this browser does not offer.' :
      `This page cannot be shown: ${error.message}`;
  throw error;
}
