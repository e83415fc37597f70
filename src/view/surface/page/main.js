// The page of a surface: puts its parts together.

import {App} from './app.js';
import {showPage} from './show_page.js';

showPage(() => new App().api());
