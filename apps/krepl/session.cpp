#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <cmath>
#include <cstdio>

#include "interrupt.hpp"
#include "verbs.hpp"

namespace krepl::app {

Session::Session() : interrupted_(watch_for_interrupts()), terminal_(isatty(STDERR_FILENO) != 0) {}
Session::~Session() { finish_progress(); }

void Session::add_common_options(Verb& verb) {
  verb.add_option("--threads", threads, "Number of threads (default: all that the machine has)")
      .within(1, 4096).type_name("N");
  Option q = verb.add_flag("--quiet", quiet, "Print errors only");
  verb.add_flag("--verbose", verbose, "Print counters, what cleaning changed, and times").excludes(q);
}

void Session::on_run(Verb& verb, std::function<int()> work) {
  verb.on_parsed([this, work = std::move(work)] { work_ = work; });
}

int Session::run() {
  int status = work_ ? work_() : 2;
  finish_progress();
  return status;
}

Context Session::context(std::string_view activity) {
  Context context;
  context.threads = threads;
  context.cancel = &interrupted_;
  if (terminal_ && !quiet) {
    drawn_percent_ = -1;
    context.progress = [this, label = std::string(activity)](double fraction) { draw_progress(label, fraction); };
  }
  return context;
}

void Session::draw_progress(std::string_view activity, double fraction) {
  constexpr int width = 40;
  int percent = static_cast<int>(100 * std::clamp(fraction, 0.0, 1.0));
  if (percent == drawn_percent_) return;
  drawn_percent_ = percent;
  std::string done(static_cast<std::size_t>(percent * width / 100), '#');
  fmt::print(stderr, "\r{:<10} [{:<{}}] {:3} %", activity, done, width, percent);
  std::fflush(stderr);
}

void Session::finish_progress() {
  if (drawn_percent_ < 0) return;
  drawn_percent_ = -1;
  fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
}

bool Session::interrupted() const { return interrupted_.load(std::memory_order_relaxed); }

void Session::note(std::string_view file, std::string_view text) {
  if (quiet) return;
  finish_progress();
  fmt::print(stderr, "krepl: {}{}{}\n", file, file.empty() ? "" : ": ", text);
}

void Session::detail(std::string_view text) {
  if (!verbose) return;
  finish_progress();
  fmt::print(stderr, "{}\n", text);
}

void Session::summary(std::string_view text, bool result_on_stdout) {
  if (quiet) return;
  finish_progress();
  fmt::print(result_on_stdout ? stderr : stdout, "{}\n", text);
}

int Session::fail(std::string_view file, const Error& error) {
  finish_progress();
  if (interrupted() || error.code == ErrorCode::cancelled) interrupt_is_reported();
  fmt::print(stderr, "krepl: {}{}{}\n", file, file.empty() ? "" : ": ", error.text());
  if (interrupted() || error.code == ErrorCode::cancelled) return interrupted_status;
  return error.code == ErrorCode::usage ? 2 : 1;
}

Result<double> parse_positive(std::string_view option, std::string_view text) {
  auto usage = [&](std::string_view what) {
    return Error{ErrorCode::usage, fmt::format("{} '{}' {}", option, text, what), "",
                 "give a finite number greater than zero, in the unit of the coordinates"};
  };
  double value = 0;
  std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (status == std::errc::result_out_of_range) return usage("is out of the range of numbers");
  if (status != std::errc{} || end != digits.data() + digits.size()) return usage("is not a number");
  if (!std::isfinite(value)) return usage("is not finite");
  if (value == 0) return usage("is zero");
  if (value < 0) return usage("is negative");
  return value;
}

Result<double> parse_radius(std::string_view text) { return parse_positive("--radius", text); }

namespace {

/// FIRST:LAST:STEP, both ends included.
Status add_range(std::string_view text, std::vector<double>& radii) {
  const std::size_t one = text.find(':'), two = text.find(':', one + 1);
  const auto usage = [&](std::string_view what, std::string_view remedy) {
    return Error{ErrorCode::usage, fmt::format("--radius '{}' {}", text, what), "", std::string(remedy)};
  };
  if (two == text.npos || text.find(':', two + 1) != text.npos)
    return usage("is not a range", "write FIRST:LAST:STEP, as 10:1000:10");
  const Result<double> first = parse_radius(text.substr(0, one)),
                       last = parse_radius(text.substr(one + 1, two - one - 1)),
                       step = parse_radius(text.substr(two + 1));
  for (const Result<double>* value : {&first, &last, &step}) {
    if (!*value) return value->error();
  }
  if (*last < *first) return usage("ends before it begins", "write FIRST:LAST:STEP, as 10:1000:10");
  constexpr double most = 100000;
  const double count = std::floor((*last - *first) / *step * (1 + 1e-12) + 1e-9) + 1;
  if (!(count <= most)) return usage("is more than 100000 radii", "take a larger step");
  for (double i = 0; i < count; ++i) radii.push_back(std::min(*first + i * *step, *last));
  return std::monostate{};
}

}  // namespace

Result<std::vector<double>> parse_radii(std::string_view text) {
  std::vector<double> radii;
  for (std::size_t begin = 0; begin <= text.size();) {
    std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    begin = end + 1;
    if (word.find(':') != word.npos) {
      if (Status range = add_range(word, radii); !range) return range.error();
      continue;
    }
    Result<double> radius = parse_radius(word);
    if (!radius) return radius.error();
    radii.push_back(*radius);
  }
  return radii;
}

}  // namespace krepl::app
