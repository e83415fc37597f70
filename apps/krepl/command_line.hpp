#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
}

namespace krepl::app {

/// An option or positional of a verb, just declared; every call says one thing more of it. CLI11 does the work, in one
/// file: its headers take longer to compile than any verb.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  Option& required();
  /// What the help calls the value.
  Option& type_name(const std::string& name);
  /// The help shows the value that the variable has now.
  Option& show_default();
  /// Whole numbers from `least` to `greatest` only.
  Option& within(int least, int greatest);
  Option& positive();
  Option& one_of(const std::vector<std::string>& words);
  /// Refuses a value if the text `fault` makes of it is not empty.
  Option& refuse_if(std::function<std::string(const std::string&)> fault);
  /// Lists: every use of the option adds one value.
  Option& one_each();
  /// Lists: values of one use are separated by this character.
  Option& separated_by(char delimiter);
  Option& excludes(const Option& other);

 private:
  CLI::Option* option_;
};

/// The program or a verb, whose options are declared by `add_option` with the variable that takes the value: it must live
/// until the command line has been parsed, which is when verbs and options end.
class Verb {
 public:
  explicit Verb(CLI::App& app) : app_(&app) {}

  Verb add_verb(const std::string& name, const std::string& what);
  /// One of its verbs must be given.
  Verb& require_verb();

  Option add_option(const std::string& name, std::string& value, const std::string& help);
  Option add_option(const std::string& name, double& value, const std::string& help);
  Option add_option(const std::string& name, int& value, const std::string& help);
  Option add_option(const std::string& name, unsigned& value, const std::string& help);
  Option add_option(const std::string& name, std::size_t& value, const std::string& help);
  Option add_option(const std::string& name, std::vector<std::string>& value, const std::string& help);
  Option add_option(const std::string& name, std::vector<std::size_t>& value, const std::string& help);
  /// An option that takes no value.
  Option add_flag(const std::string& name, bool& value, const std::string& help);

  /// What happens when the command line names this verb.
  void on_parsed(std::function<void()> action);

  struct Entry {
    std::string name, what;
  };
  /// Its verbs, in the order in which they were added.
  std::vector<Entry> verbs() const;

 private:
  CLI::App* app_;
};

/// What a command line asks for.
struct Parsed {
  bool finished = false;  ///< nothing is left to do: help or the version was printed, or the usage is wrong
  int status = 0;         ///< exit status, if finished
};

/// The program: declares its verbs by `declare`, and parses the command line.
Parsed parse_command_line(int argc, char** argv, const std::function<void(Verb&)>& declare);

}  // namespace krepl::app
