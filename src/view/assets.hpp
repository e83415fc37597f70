#pragma once

namespace krepl::view {

/// The parts of the page, from src/view/page. The template has the marks {{title}}, {{style}}, {{data}} and {{script}}.
extern const char* const page_template;
extern const char* const page_style;
extern const char* const page_script;

/// The same for surfaces, from src/view/surface/page, with three.js in the script. Without npm at hand when krepl was
/// built the script is empty.
extern const char* const surface_template;
extern const char* const surface_style;
extern const char* const surface_script;

/// The same for tool paths, from src/view/surface/page/path.
extern const char* const path_template;
extern const char* const path_style;
extern const char* const path_script;

}  // namespace krepl::view
