#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "command_line.hpp"
#include "krepl/context.hpp"
#include "krepl/error.hpp"

namespace krepl::app {

/// What all verbs of one run share: the common options, how to talk to the user, and what to do after parsing.
///
/// A verb is added by a function that declares its options, and gives its work to `on_run`; the work starts after the
/// whole command line has been accepted and returns the exit status:
///
///     void add_thing_verb(Verb& program, Session& session) {
///       auto options = std::make_shared<ThingOptions>();
///       Verb verb = program.add_verb("thing", "What it does");
///       verb.add_option("IN", options->input, "Input file").required();
///       session.add_common_options(verb);
///       session.on_run(verb, [options, &session] { return run_thing(*options, session); });
///     }
class Session {
 public:
  Session();
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  unsigned threads = 0;  ///< --threads; 0: all
  bool quiet = false;    ///< --quiet: errors only
  bool verbose = false;  ///< --verbose: counters, cleaning report, times

  /// Declares --threads, --quiet and --verbose.
  void add_common_options(Verb& verb);
  /// Registers the work of a verb.
  void on_run(Verb& verb, std::function<int()> work);
  /// The registered work of the verb that was given; called once by main.
  int run();

  /// For a long computation: the threads asked for, a progress bar (only on a terminal and without --quiet) labelled
  /// `activity`, and the flag that Ctrl-C sets. The bar goes away with the next message or finish_progress().
  Context context(std::string_view activity);
  void finish_progress();
  /// True after Ctrl-C.
  bool interrupted() const;

  /// `krepl: FILE: TEXT` on standard error; nothing with --quiet. An empty file name is left out.
  void note(std::string_view file, std::string_view text);
  /// A line on standard error, with --verbose only.
  void detail(std::string_view text);
  /// The short line at the end, on standard output (on standard error if the result itself goes there); nothing with
  /// --quiet.
  void summary(std::string_view text, bool result_on_stdout = false);
  /// `krepl: FILE: what, where; remedy` on standard error, always. Returns the exit status: 2 for usage, 130 after Ctrl-C,
  /// otherwise 1. An empty file name is left out.
  int fail(std::string_view file, const Error& error);

 private:
  void draw_progress(std::string_view activity, double fraction);
  const std::atomic<bool>& interrupted_;
  std::function<int()> work_;
  bool terminal_ = false;
  int drawn_percent_ = -1;
};

/// What messages call a file: `-` is a standard stream.
inline std::string input_name(const std::string& path) { return path == "-" ? "standard input" : path; }
inline std::string output_name(const std::string& path) { return path == "-" ? "standard output" : path; }

/// One or more radii separated by commas, each finite and positive, or ranges FIRST:LAST:STEP; an Error of code usage
/// names what is wrong.
Result<std::vector<double>> parse_radii(std::string_view text);
/// Exactly one radius, finite and positive.
Result<double> parse_radius(std::string_view text);
/// A finite positive number for the option `option`, as `--max-error`.
Result<double> parse_positive(std::string_view option, std::string_view text);

void add_axis_verb(Verb& program, Session& session);
void add_buffer_verb(Verb& program, Session& session);
void add_contour_verb(Verb& program, Session& session);
void add_free_verb(Verb& program, Session& session);
void add_height_verb(Verb& program, Session& session);
void add_info_verb(Verb& program, Session& session);
void add_lab_verb(Verb& program, Session& session);
void add_mill_verb(Verb& program, Session& session);
void add_offset_verb(Verb& program, Session& session);
void add_profile_verb(Verb& program, Session& session);
void add_rivers_verb(Verb& program, Session& session);
void add_section_verb(Verb& program, Session& session);
void add_simulate_verb(Verb& program, Session& session);
void add_route_verb(Verb& program, Session& session);
void add_terrain_verb(Verb& program, Session& session);
void add_verify_verb(Verb& program, Session& session);
void add_view_verb(Verb& program, Session& session);

}  // namespace krepl::app
