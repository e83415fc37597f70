#include "command_line.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <utility>

namespace krepl::app {

namespace {

constexpr int usage_status = 2;

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

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::type_name(const std::string& name) {
  option_->type_name(name);
  return *this;
}

Option& Option::show_default() {
  option_->capture_default_str();
  return *this;
}

Option& Option::within(int least, int greatest) {
  option_->check(CLI::Range(least, greatest));
  return *this;
}

Option& Option::positive() {
  option_->check(CLI::PositiveNumber);
  return *this;
}

Option& Option::one_of(const std::vector<std::string>& words) {
  option_->check(CLI::IsMember(words));
  return *this;
}

Option& Option::refuse_if(std::function<std::string(const std::string&)> fault) {
  option_->check(std::move(fault));
  return *this;
}

Option& Option::one_each() {
  option_->expected(1)->allow_extra_args(false)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  return *this;
}

Option& Option::separated_by(char delimiter) {
  option_->delimiter(delimiter);
  return *this;
}

Option& Option::excludes(const Option& other) {
  option_->excludes(other.option_);
  return *this;
}

Verb Verb::add_verb(const std::string& name, const std::string& what) { return Verb(*app_->add_subcommand(name, what)); }

Verb& Verb::require_verb() {
  app_->require_subcommand(1);
  return *this;
}

Option Verb::add_option(const std::string& name, std::string& value, const std::string& help) {
  return Option(app_->add_option(name, value, help));
}
Option Verb::add_option(const std::string& name, double& value, const std::string& help) {
  return Option(app_->add_option(name, value, help));
}
Option Verb::add_option(const std::string& name, int& value, const std::string& help) {
  return Option(app_->add_option(name, value, help));
}
Option Verb::add_option(const std::string& name, unsigned& value, const std::string& help) {
  return Option(app_->add_option(name, value, help));
}
Option Verb::add_option(const std::string& name, std::size_t& value, const std::string& help) {
  return Option(app_->add_option(name, value, help));
}
Option Verb::add_option(const std::string& name, std::vector<std::string>& value, const std::string& help) {
  return Option(app_->add_option(name, value, help));
}
Option Verb::add_option(const std::string& name, std::vector<std::size_t>& value, const std::string& help) {
  return Option(app_->add_option(name, value, help));
}
Option Verb::add_flag(const std::string& name, bool& value, const std::string& help) {
  return Option(app_->add_flag(name, value, help));
}

void Verb::on_parsed(std::function<void()> action) { app_->callback(std::move(action)); }

std::vector<Verb::Entry> Verb::verbs() const {
  std::vector<Entry> entries;
  for (const CLI::App* verb : app_->get_subcommands([](const CLI::App*) { return true; }))
    entries.push_back({verb->get_name(), verb->get_description()});
  return entries;
}

Parsed parse_command_line(int argc, char** argv, const std::function<void(Verb&)>& declare) {
  CLI::App program{"Exact Minkowski sums with a ball: buffer zones with true arcs, offset profiles and surfaces", "krepl"};
  program.set_version_flag("--version", "krepl " KREPL_VERSION);
  program.require_subcommand(1);
  program.get_formatter()->column_width(34);
  program.failure_message(CLI::FailureMessage::simple);
  Verb top(program);
  declare(top);
  program.footer(  // last: verbs take over what is there when they are added
      "`-` is standard input or output where the format is text. Exit status: 0 done, 1 bad input or a failed\n"
      "computation, 2 wrong usage, 130 interrupted. `krepl VERB --help` explains a verb.");
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& request) {  // --help, --version
    return {true, program.exit(request)};
  } catch (const CLI::ParseError& error) {
    return {true, usage_error(program, error)};
  }
  return {};
}

}  // namespace krepl::app
