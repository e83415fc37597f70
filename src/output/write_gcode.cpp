#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>

#include "output/gcode_file.hpp"
#include "output/output_stream.hpp"

namespace krepl::output {
namespace {

/// A comment must not hold parentheses, and controllers take ASCII only.
std::string comment_text(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '(' || c == ')' || c < ' ' || c > '~' ? '_' : c;
  return out;
}

class GcodeWriter {
 public:
  GcodeWriter(const GcodeOptions& options, OutputStream& stream)
      : o_(options), stream_(stream), scale_(std::pow(10.0, options.decimals)) {}

  std::size_t lines() const { return lines_; }

  void header(Point3 start) {
    const char* unit = o_.inches ? "inch" : "mm";
    line("({} by krepl)", comment_text(o_.part_name + ", " + o_.strategy));
    line("(tool table: T{} D{:.{}f} {}, lengths in {}, Z is that of the tool's {})", o_.tool_number, o_.tool_diameter,
         o_.decimals, comment_text(o_.tool_name), unit,
         o_.below_centre != 0 || !o_.has_centre ? "tip" : "centre");
    line("{} G90 G94 G17 G40 G49 G80 G61", o_.inches ? "G20" : "G21");
    if (o_.post == GcodePost::linuxcnc) {
      line("G91.1");
      line("T{} M6", o_.tool_number);
      line("G43 H{}", o_.tool_number);
    }
    if (o_.spindle_speed > 0) line("S{:.0f} M3", o_.spindle_speed);
    // Up before aside.
    at_ = numbers(start);
    text_ = "G0 Z";
    append(at_[2]);
    end_line();
    text_ = "X";
    append(at_[0]);
    text_ += " Y";
    append(at_[1]);
    end_line();
    motion_ = 0;
  }

  void move(const Move& m) {
    const bool arc = m.kind == MoveKind::clockwise || m.kind == MoveKind::counter_clockwise;
    const std::array<std::int64_t, 3> to = numbers(m.end);
    text_.clear();
    if (arc && plane_ != m.plane) {
      word(m.plane == ArcPlane::xy ? "G17" : m.plane == ArcPlane::zx ? "G18" : "G19");
      plane_ = m.plane;
    }
    const int motion = m.kind == MoveKind::rapid       ? 0
                       : m.kind == MoveKind::line      ? 1
                       : m.kind == MoveKind::clockwise ? 2
                                                       : 3;
    if (motion != motion_) word(fmt::format("G{}", motion));
    motion_ = motion;
    bool moves = false;
    for (std::size_t i = 0; i < 3; ++i) {
      if (to[i] == at_[i]) continue;
      coordinate("XYZ"[i], to[i]);
      moves = true;
    }
    if (arc) centre(m);
    if (!moves && !arc) return;  // nothing left of it
    if (m.kind != MoveKind::rapid && m.feed != feed_) {
      word(fmt::format("F{:.10g}", m.feed));
      feed_ = m.feed;
    }
    at_ = to;
    end_line();
  }

  void footer() {
    if (plane_ != ArcPlane::xy) line("G17");
    if (o_.spindle_speed > 0) line("M5");
    line("M2");
    flush();
  }
  void flush() {
    stream_.write(block_);
    block_.clear();
  }
  bool is_full() const { return block_.size() > (1u << 17); }

 private:
  std::array<std::int64_t, 3> numbers(Point3 p) const {
    return {std::llround(p.x * scale_), std::llround(p.y * scale_), std::llround((p.z - o_.below_centre) * scale_)};
  }
  /// From the start of the arc, in its plane.
  void centre(const Move& m) {
    const std::array<std::int64_t, 3> c = numbers(m.centre);
    if (m.plane != ArcPlane::yz) coordinate('I', c[0] - at_[0]);
    if (m.plane != ArcPlane::zx) coordinate('J', c[1] - at_[1]);
    if (m.plane != ArcPlane::xy) coordinate('K', c[2] - at_[2]);
  }
  void word(const std::string& w) {
    if (!text_.empty()) text_ += ' ';
    text_ += w;
  }
  void coordinate(char name, std::int64_t number) {
    if (!text_.empty()) text_ += ' ';
    text_ += name;
    append(number);
  }
  /// A number in units of the last decimal, without zeros at its end.
  void append(std::int64_t number) {
    std::string digits = std::to_string(number < 0 ? -number : number);
    const std::size_t decimals = std::size_t(o_.decimals);
    if (digits.size() <= decimals) digits.insert(0, decimals + 1 - digits.size(), '0');
    std::size_t end = digits.size();
    while (end > digits.size() - decimals && digits[end - 1] == '0') --end;
    if (number < 0) text_ += '-';
    text_.append(digits, 0, digits.size() - decimals);
    if (end > digits.size() - decimals) {
      text_ += '.';
      text_.append(digits, digits.size() - decimals, end - (digits.size() - decimals));
    }
  }
  template <class... Arguments>
  void line(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    text_ = fmt::format(format, std::forward<Arguments>(arguments)...);
    end_line();
  }
  void end_line() {
    block_ += text_;
    block_ += '\n';
    text_.clear();
    ++lines_;
  }

  const GcodeOptions& o_;
  OutputStream& stream_;
  double scale_;
  std::string text_, block_;
  std::array<std::int64_t, 3> at_{};
  int motion_ = -1;
  ArcPlane plane_ = ArcPlane::xy;
  double feed_ = -1;
  std::size_t lines_ = 0;
};

}  // namespace

Result<std::size_t> write_gcode(const std::string& path, const ToolPath& tool_path, const GcodeOptions& options,
                                const Context& context) {
  Result<OutputStream> stream = OutputStream::open(path);
  if (!stream) return stream.error();
  GcodeWriter writer(options, *stream);
  writer.header(tool_path.start);
  for (const Move& move : tool_path.moves) {
    writer.move(move);
    if (!writer.is_full()) continue;
    writer.flush();
    if (context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  }
  writer.footer();
  if (Status finished = stream->finish(); !finished) return finished.error();
  return writer.lines();
}

}  // namespace krepl::output
