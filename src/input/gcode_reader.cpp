#include "input/gcode_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>

#include "input/gcode_line.hpp"
#include "input/whole_file.hpp"

namespace krepl::input {
namespace {

constexpr double inch = 25.4;
constexpr double arc_slack_mm = 0.005, arc_slack_ratio = 1e-3;

/// G and M words by ten times their number.
constexpr int ignored_g[] = {400, 430 /* the offset is taken as set right */, 490, 540, 610, 611, 640, 940, 970, 980, 990};
constexpr int ignored_m[] = {0, 10, 30, 40, 50, 60, 70, 80, 90, 480, 490};

/// -1 for numbers that are no code.
int tenfold(double value) {
  const double code = std::round(value * 10);
  return value >= 0 && value < 1000 && std::abs(value * 10 - code) < 1e-9 ? int(code) : -1;
}
template <std::size_t n>
bool holds(const int (&list)[n], int code) {
  for (const int each : list)
    if (each == code) return true;
  return false;
}

/// The machine's state as the lines leave it, and the moves they make.
class Interpreter {
 public:
  Interpreter(double millimetres, GCodeFile& file) : file_(file), millimetres_(millimetres) { set_unit(1); }

  Status take(const std::vector<GCodeWord>& words, std::size_t line);
  bool ended() const { return ended_; }

 private:
  struct Line {
    std::size_t number = 0;
    std::array<std::optional<double>, 3> axis, centre;  // x y z, i j k
    std::optional<double> radius, turns, dwell;
    bool moves() const { return axis[0] || axis[1] || axis[2]; }
    bool has_centre() const { return centre[0] || centre[1] || centre[2]; }
  };

  Error error(const Line& line, std::string what, std::string remedy = "correct the file") const {
    return {ErrorCode::input, std::move(what), gcode_place(line.number), std::move(remedy)};
  }
  void set_unit(double in_millimetres) { unit_ = in_millimetres / millimetres_; }
  Status take_g(double value, Line& line);
  Status take_m(double value, const Line& line);
  Status take_tool(double value, const Line& line);
  Status take_word(const GCodeWord& word, Line& line);
  Status move(const Line& line);
  Status arc(const Line& line, Point3 from, Move& move) const;
  Status centre_by_radius(const Line& line, Point3 from, Move& move) const;
  Status check_radii(const Line& line, Point3 from, const Move& move) const;
  void note_once(bool& noted, const char* text) {
    if (!noted) file_.notes.push_back(text);
    noted = true;
  }

  GCodeFile& file_;
  double millimetres_, unit_ = 1;  // of a number in the file, in the part's
  std::optional<MoveKind> motion_;
  ArcPlane plane_ = ArcPlane::xy;
  bool absolute_ = true, centres_absolute_ = false, ended_ = false, started_ = false;
  std::array<std::optional<double>, 3> position_;
  double feed_ = 0;
  std::optional<double> tool_;
  bool noted_dwell_ = false, noted_blend_ = false;
};

Status Interpreter::take_g(double value, Line& line) {
  const int code = tenfold(value);
  switch (code) {
    case 0:
      motion_ = MoveKind::rapid;
      return std::monostate{};
    case 10:
      motion_ = MoveKind::line;
      return std::monostate{};
    case 20:
      motion_ = MoveKind::clockwise;
      return std::monostate{};
    case 30:
      motion_ = MoveKind::counter_clockwise;
      return std::monostate{};
    case 40:
      line.dwell = 0;
      note_once(noted_dwell_, "dwells are not counted in the time");
      return std::monostate{};
    case 170:
      plane_ = ArcPlane::xy;
      return std::monostate{};
    case 180:
      plane_ = ArcPlane::zx;
      return std::monostate{};
    case 190:
      plane_ = ArcPlane::yz;
      return std::monostate{};
    case 200:
      set_unit(inch);
      return std::monostate{};
    case 210:
      set_unit(1);
      return std::monostate{};
    case 800:
      motion_.reset();
      return std::monostate{};
    case 900:
      absolute_ = true;
      return std::monostate{};
    case 901:
      centres_absolute_ = true;
      return std::monostate{};
    case 910:
      absolute_ = false;
      return std::monostate{};
    case 911:
      centres_absolute_ = false;
      return std::monostate{};
    default:
      break;
  }
  if (code == 640) note_once(noted_blend_, "G64 lets the machine cut corners; the path is taken as it is written");
  if (holds(ignored_g, code)) return std::monostate{};
  return error(line, fmt::format("G{} is not read", value), "have the program written with G0, G1, G2 and G3 only");
}

Status Interpreter::take_m(double value, const Line& line) {
  const int code = tenfold(value);
  if (code == 20 || code == 300) {
    ended_ = true;
    return std::monostate{};
  }
  if (holds(ignored_m, code)) return std::monostate{};
  return error(line, fmt::format("M{} is not read", value), "take it out if it does not move the tool");
}

Status Interpreter::take_tool(double value, const Line& line) {
  if (tool_ && *tool_ != value && started_)
    return error(line, fmt::format("a second tool, T{}", value), "give the moves of one tool at a time");
  tool_ = value;
  return std::monostate{};
}

Status Interpreter::take_word(const GCodeWord& word, Line& line) {
  const auto set = [&](std::optional<double>& place) -> Status {
    if (place) return error(line, fmt::format("{} is there twice", word.letter));
    place = word.value;
    return std::monostate{};
  };
  switch (word.letter) {
    case 'G':
      return take_g(word.value, line);
    case 'M':
      return take_m(word.value, line);
    case 'T':
      return take_tool(word.value, line);
    case 'X':
    case 'Y':
    case 'Z':
      return set(line.axis[std::size_t(word.letter - 'X')]);
    case 'I':
    case 'J':
    case 'K':
      return set(line.centre[std::size_t(word.letter - 'I')]);
    case 'R':
      return set(line.radius);
    case 'P':
      return set(line.turns);
    case 'F':
    case 'S':
    case 'H':
    case 'D':
    case 'Q':
      return std::monostate{};  // F: before all others
    default:
      break;
  }
  return error(line, gcode_text(word) + " is not read", "three axes X, Y and Z and plain words only");
}

Status Interpreter::take(const std::vector<GCodeWord>& words, std::size_t number) {
  Line line;
  line.number = number;
  // Units, planes and distances count for the whole line, wherever in it they stand.
  for (const GCodeWord& word : words)
    if (word.letter == 'G' || word.letter == 'M' || word.letter == 'T')
      if (Status taken = take_word(word, line); !taken) return taken;
  for (const GCodeWord& word : words) {
    if (word.letter == 'G' || word.letter == 'M' || word.letter == 'T') continue;
    if (word.letter == 'F')
      feed_ = word.value * unit_;
    else if (Status taken = take_word(word, line); !taken)
      return taken;
  }
  return line.moves() || (line.has_centre() && motion_) ? move(line) : Status(std::monostate{});
}

Status Interpreter::move(const Line& line) {
  if (!motion_) return error(line, "coordinates without G0, G1, G2 or G3");
  const bool known = position_[0] && position_[1] && position_[2];
  std::array<std::optional<double>, 3> to = position_;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!line.axis[i]) continue;
    if (!absolute_ && !position_[i])
      return error(line, "a relative move from a place that is not known", "begin with G90 and X, Y and Z");
    to[i] = *line.axis[i] * unit_ + (absolute_ ? 0 : *position_[i]);
  }
  const auto point = [](const auto& p) { return Point3{*p[0], *p[1], *p[2]}; };
  if (!known) {
    if (motion_ != MoveKind::rapid)
      return error(line, "a cutting move from a place that is not known", "begin with G0 and X, Y and Z");
    position_ = to;
    if (to[0] && to[1] && to[2]) file_.path.start = point(to);
    return std::monostate{};
  }
  Move move;
  move.kind = *motion_, move.plane = plane_, move.end = point(to);
  if (move.kind != MoveKind::rapid) {
    if (!(feed_ > 0)) return error(line, "a cutting move without a feed", "add an F word");
    move.feed = feed_;
  }
  if (move.kind == MoveKind::clockwise || move.kind == MoveKind::counter_clockwise) {
    if (Status done = arc(line, point(position_), move); !done) return done;
  } else if (line.has_centre() || line.radius) {
    return error(line, "I, J, K or R in a straight move");
  }
  position_ = to;
  started_ = true;
  file_.path.moves.push_back(move);
  file_.line.push_back(line.number);
  return std::monostate{};
}

/// The axes of an arc's plane, first and second, seen against the third.
std::array<std::size_t, 2> plane_axes(ArcPlane plane) {
  switch (plane) {
    case ArcPlane::xy:
      return {0, 1};
    case ArcPlane::zx:
      return {2, 0};
    case ArcPlane::yz:
      return {1, 2};
  }
  return {};
}
double coordinate(Point3 p, std::size_t axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }
void set_coordinate(Point3& p, std::size_t axis, double value) { (axis == 0 ? p.x : axis == 1 ? p.y : p.z) = value; }

Status Interpreter::arc(const Line& line, Point3 from, Move& move) const {
  if (line.turns && *line.turns != 1) return error(line, "an arc of several turns", "write the turns one by one");
  if (line.radius && line.has_centre()) return error(line, "an arc with both a radius and a centre");
  move.centre = from;
  if (line.radius) return centre_by_radius(line, from, move);
  const auto axes = plane_axes(move.plane);
  if (!line.centre[axes[0]] && !line.centre[axes[1]]) return error(line, "an arc without its centre in its plane");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!line.centre[axis]) continue;
    if (axis != axes[0] && axis != axes[1]) return error(line, "a centre outside of the arc's plane");
  }
  for (const std::size_t axis : axes) {
    if (centres_absolute_ && !line.centre[axis]) return error(line, "an absolute centre lacks a coordinate");
    const double offset = line.centre[axis].value_or(0) * unit_;
    set_coordinate(move.centre, axis, centres_absolute_ ? offset : coordinate(from, axis) + offset);
  }
  return check_radii(line, from, move);
}

Status Interpreter::centre_by_radius(const Line& line, Point3 from, Move& move) const {
  const auto axes = plane_axes(move.plane);
  const double r = *line.radius * unit_;
  const double u = coordinate(move.end, axes[0]) - coordinate(from, axes[0]);
  const double v = coordinate(move.end, axes[1]) - coordinate(from, axes[1]);
  const double chord = std::hypot(u, v), slack = arc_slack_mm / millimetres_;
  if (chord == 0) return error(line, "an arc by its radius that ends where it begins", "give its centre by I, J, K");
  if (2 * std::abs(r) < chord - slack) return error(line, "a radius too short for the ends of its arc");
  const double height = std::sqrt(std::max(0.0, r * r - chord * chord / 4));
  // To the left of the chord for the shorter way counter-clockwise; a negative radius takes the longer way.
  const double side = (move.kind == MoveKind::counter_clockwise) == (r > 0) ? 1 : -1;
  set_coordinate(move.centre, axes[0], coordinate(from, axes[0]) + u / 2 - side * height * v / chord);
  set_coordinate(move.centre, axes[1], coordinate(from, axes[1]) + v / 2 + side * height * u / chord);
  return std::monostate{};
}

Status Interpreter::check_radii(const Line& line, Point3 from, const Move& move) const {
  const auto axes = plane_axes(move.plane);
  const auto distance = [&](Point3 p) {
    return std::hypot(coordinate(p, axes[0]) - coordinate(move.centre, axes[0]),
                      coordinate(p, axes[1]) - coordinate(move.centre, axes[1]));
  };
  const double a = distance(from), b = distance(move.end);
  if (!(a > 0)) return error(line, "an arc of radius zero");
  const double off = std::abs(a - b);
  if (off * millimetres_ > arc_slack_mm && off > arc_slack_ratio * a)
    return error(line, fmt::format("an arc whose ends are {:.6g} and {:.6g} from its centre", a / unit_, b / unit_));
  return std::monostate{};
}

}  // namespace

Result<GCodeFile> parse_gcode(std::string_view text, double millimetres, const Context& context) {
  GCodeFile file;
  Interpreter interpreter(millimetres, file);
  for (std::size_t line = 1; !text.empty() && !interpreter.ended(); ++line) {
    if (line % 4096 == 0 && context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
    const std::size_t end = text.find('\n');
    const Result<std::vector<GCodeWord>> words = gcode_words(text.substr(0, end), line);
    if (!words) return words.error();
    if (Status taken = interpreter.take(*words, line); !taken) return taken.error();
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  if (file.path.moves.empty()) return Error{ErrorCode::input, "holds no move", "", "give a program with G1, G2 or G3"};
  return file;
}

Result<GCodeFile> read_gcode(const std::string& path, double millimetres, const Context& context) {
  const Result<std::vector<char>> bytes = read_whole_file(path, context);
  if (!bytes) return bytes.error();
  return parse_gcode({bytes->data(), bytes->size()}, millimetres, context);
}

}  // namespace krepl::input
