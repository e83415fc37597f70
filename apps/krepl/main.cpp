#include <CLI/CLI.hpp>
#include <cstdio>
#include <new>
#include <string>

#include "verbs.hpp"

namespace {

constexpr int usage_status = 2;

void describe(CLI::App& program) {
  program.set_version_flag("--version", "krepl " KREPL_VERSION);
  program.require_subcommand(1);
  program.get_formatter()->column_width(34);
  program.failure_message(CLI::FailureMessage::simple);
}

/// After the verbs were added: they would repeat it.
void add_footer(CLI::App& program) {
  program.footer(
      "`-` is standard input or output where the format is text. Exit status: 0 done, 1 bad input or a failed\n"
      "computation, 2 wrong usage, 130 interrupted. `krepl VERB --help` explains a verb.");
}

/// The verb that the command line got to before parsing stopped: the one whose help is of use.
std::string help_command(const CLI::App& program) {
  std::string command = "krepl";
  for (const CLI::App* verb : program.get_subcommands()) command += " " + verb->get_name();
  return command + " --help";
}

int usage_error(const CLI::App& program, const CLI::ParseError& error) {
  std::string what = error.what();
  if (program.get_subcommands().empty() && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    what = "no verb given";
  }
  std::fprintf(stderr, "krepl: %s; see `%s`\n", what.c_str(), help_command(program).c_str());
  return usage_status;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program{"Exact Minkowski sums with a ball: buffer zones with true arcs, offset profiles and surfaces", "krepl"};
  krepl::app::Session session;
  describe(program);
  krepl::app::add_buffer_verb(program, session);
  krepl::app::add_axis_verb(program, session);
  krepl::app::add_rivers_verb(program, session);
  krepl::app::add_offset_verb(program, session);
  krepl::app::add_profile_verb(program, session);
  krepl::app::add_simulate_verb(program, session);
  krepl::app::add_terrain_verb(program, session);
  krepl::app::add_height_verb(program, session);
  krepl::app::add_free_verb(program, session);
  krepl::app::add_contour_verb(program, session);
  krepl::app::add_section_verb(program, session);
  krepl::app::add_mill_verb(program, session);
  krepl::app::add_route_verb(program, session);
  krepl::app::add_verify_verb(program, session);
  krepl::app::add_info_verb(program, session);
  krepl::app::add_view_verb(program, session);
  krepl::app::add_lab_verb(program, session);
  add_footer(program);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& request) {  // --help, --version
    return program.exit(request);
  } catch (const CLI::ParseError& error) {
    return usage_error(program, error);
  }
  try {
    return session.run();
  } catch (const std::bad_alloc&) {
    return session.fail("", {krepl::ErrorCode::computation, "not enough memory", "", "free memory or take less data"});
  }
}
