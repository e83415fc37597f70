#include "profile_files.hpp"

#include <algorithm>
#include <cmath>

#include "number_text.hpp"
#include "output/output_stream.hpp"

namespace krepl::app {

namespace {

constexpr std::size_t rows_at_a_time = 8192;

void append(std::string& text, Point p, char between) {
  append_number(text, p.x);
  text += between;
  append_number(text, p.y);
}

const char* kind_name(ProfilePiece::Kind kind) {
  switch (kind) {
    case ProfilePiece::Kind::half_line: return "half_line";
    case ProfilePiece::Kind::segment: return "segment";
    case ProfilePiece::Kind::arc: return "arc";
  }
  return "";
}

void append_row(std::string& text, const ProfileRow& row) {
  text += kind_name(row.kind);
  text += ',';
  append(text, row.start, ',');
  text += ',';
  append(text, row.end, ',');
  text += ',';
  if (row.kind == ProfilePiece::Kind::arc) append(text, row.center, ',');
  else text += ',';
  text += ',';
  text += profile_cause(row);
  text += '\n';
}

/// Writes in portions, looks for cancelling between them, and finishes the stream.
class Portions {
 public:
  Portions(output::OutputStream stream, const Context& context, std::size_t total)
      : stream_(std::move(stream)), context_(context), total_(total) {}
  std::string text;

  /// After each item; false: stop.
  bool next() {
    if (++done_ % rows_at_a_time != 0) return true;
    stream_.write(text);
    text.clear();
    if (context_.progress) context_.progress(double(done_) / double(total_));
    return !context_.cancelled() && !stream_.failed();
  }
  Status finish() {
    if (context_.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
    stream_.write(text);
    return stream_.finish();
  }

 private:
  output::OutputStream stream_;
  const Context& context_;
  std::size_t total_, done_ = 0;
};

struct Frame {
  double x0, y0, width, height;  // y0 at the top
  Point map(Point p) const { return {p.x - x0, y0 - p.y}; }
};

Frame frame_of(const Profile& profile) {
  double low = profile.terrain[0].y, high = low;
  for (const Point& p : profile.terrain) low = std::min(low, p.y), high = std::max(high, p.y);
  const double x0 = profile.terrain.front().x - profile.radius, x1 = profile.terrain.back().x + profile.radius;
  const double margin = std::max({0.02 * (x1 - x0), 0.05 * (high + profile.radius - low), 0.1 * profile.radius});
  return {x0 - margin, high + profile.radius + margin, x1 - x0 + 2 * margin, high + profile.radius - low + 2 * margin};
}

void begin_svg(std::string& text, const Frame& frame, double radius) {
  const double pixels_x = 1200, pixels_y = std::clamp(pixels_x * frame.height / frame.width, 60.0, 1200.0);
  text += "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"";
  append_number(text, pixels_x);
  text += "\" height=\"";
  append_number(text, std::round(pixels_y));
  text += "\" viewBox=\"0 0 ";
  append(text, {frame.width, frame.height}, ' ');
  text += "\">\n<title>Terrain (+) disk of radius ";
  append_number(text, radius);
  text += "</title>\n<style>path{stroke-width:1.2;vector-effect:non-scaling-stroke;stroke-linejoin:round}"
          "#sum{fill:#cfe3f5;stroke:#1f6fb2}#terrain{fill:#8a7a66;stroke:#4d4336}</style>\n";
}

}  // namespace

Status write_profile_csv(const std::string& path, const Profile& profile, const Context& context) {
  Result<output::OutputStream> stream = output::OutputStream::open(path);
  if (!stream) return stream.error();
  Portions out(std::move(*stream), context, profile.pieces.size());
  out.text = "kind,x0,y0,x1,y1,cx,cy,segment\n";
  for (std::size_t k = 0; k < profile.pieces.size(); ++k) {
    append_row(out.text, profile.row(k));
    if (!out.next()) break;
  }
  return out.finish();
}

Status write_profile_svg(const std::string& path, const Profile& profile, const Context& context) {
  Result<output::OutputStream> stream = output::OutputStream::open(path);
  if (!stream) return stream.error();
  const Frame frame = frame_of(profile);
  Portions out(std::move(*stream), context, profile.pieces.size() + profile.terrain.size());
  begin_svg(out.text, frame, profile.radius);
  const std::size_t last = profile.pieces.size() - 1;
  out.text += "<path id=\"sum\" d=\"M";
  append(out.text, {frame.map(profile.row(0).end).x, frame.height}, ' ');
  for (std::size_t k = 0; k < last; ++k) {
    const ProfileRow row = profile.row(k);
    if (row.kind == ProfilePiece::Kind::arc) {
      out.text += "\nA";
      append(out.text, {profile.radius, profile.radius}, ' ');
      out.text += " 0 0 1 ";  // at most half a turn; clockwise, as y points down
    } else {
      out.text += "\nL";
    }
    append(out.text, frame.map(row.end), ' ');
    if (!out.next()) return out.finish();
  }
  out.text += "\nV";
  append_number(out.text, frame.height);
  out.text += "\"/>\n<path id=\"terrain\" d=\"M";
  append(out.text, {frame.map(profile.terrain.front()).x, frame.height}, ' ');
  for (const Point& p : profile.terrain) {
    out.text += "\nL";
    append(out.text, frame.map(p), ' ');
    if (!out.next()) return out.finish();
  }
  out.text += "\nV";
  append_number(out.text, frame.height);
  out.text += "\"/>\n</svg>\n";
  return out.finish();
}

}  // namespace krepl::app
