// The page of a tool path: puts its parts together.

import {showPage} from '../show_page.js';
import {PathApp} from './path_app.js';

showPage(() => new PathApp().api());
