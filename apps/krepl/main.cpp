#include <new>

#include "command_line.hpp"
#include "verbs.hpp"

namespace {

using namespace krepl::app;

/// In the order in which the help lists them.
void declare_verbs(Verb& program, Session& session) {
  for (void (*add)(Verb&, Session&) :
       {add_buffer_verb, add_axis_verb, add_rivers_verb, add_offset_verb, add_profile_verb, add_simulate_verb,
        add_terrain_verb, add_height_verb, add_free_verb, add_contour_verb, add_section_verb, add_mill_verb, add_route_verb,
        add_verify_verb, add_info_verb, add_view_verb, add_lab_verb})
    add(program, session);
}

}  // namespace

int main(int argc, char** argv) {
  Session session;
  const Parsed parsed = parse_command_line(argc, argv, [&](Verb& program) { declare_verbs(program, session); });
  if (parsed.finished) return parsed.status;
  try {
    return session.run();
  } catch (const std::bad_alloc&) {
    return session.fail("", {krepl::ErrorCode::computation, "not enough memory", "", "free memory or take less data"});
  }
}
