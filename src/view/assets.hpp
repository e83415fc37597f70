#pragma once

namespace krepl::view {

/// The parts of the page, from src/view/page. The template has the marks {{title}}, {{style}}, {{data}} and {{script}}.
extern const char* const page_template;
extern const char* const page_style;
extern const char* const page_script;

}  // namespace krepl::view
