// Starts a page in space, or says why it cannot be shown.

export function showPage(start) {
  try {
    window.kreplView = start();
  } catch (error) {
    const failure = document.getElementById('failure');
    failure.hidden = false;
    failure.textContent = /webgl/i.test(error.message) ?
        'This page draws with WebGL 2, which this browser does not offer.' :
        `This page cannot be shown: ${error.message}`;
    throw error;
  }
}
