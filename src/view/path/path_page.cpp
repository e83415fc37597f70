#include "view/path/path_page.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulate/path_pieces.hpp"
#include "view/assets.hpp"
#include "view/page_parts.hpp"
#include "view/surface/layer_writer.hpp"
#include "view/surface/tile_encoding.hpp"

namespace krepl::view {

namespace {

using Json = nlohmann::ordered_json;
using simulate::Piece;

constexpr double arc_error_of_cell = 1.0 / 50, arc_error_of_radius = 1e-3;
constexpr double rapid_of_feed = 2;
constexpr double beside_part = -1e30;  // heights of the part where it has none: single precision has to hold them

double fastest_feed(const ToolPath& path) {
  double fastest = 0;
  for (const Move& move : path.moves)
    if (move.kind != MoveKind::rapid) fastest = std::max(fastest, move.feed);
  return fastest > 0 ? fastest : 1;
}

/// The pieces' ends one after the other, byte planes of x, y, z and the time at which the tool is there; then the move of each
/// piece. page/path/timeline.js reads them.
class Track {
 public:
  Track(const PathPageData& data, Point3 origin, double arc_error)
      : pieces_(simulate::pieces_of(*data.path, origin, data.cutter.control_height(), arc_error)) {
    const double rapid = rapid_of_feed * fastest_feed(*data.path);
    add(pieces_.empty() ? Point3{} : pieces_.front().from, 0);
    for (const Piece& piece : pieces_) {
      const Move& move = data.path->moves[piece.move];
      const double length =
          std::hypot(piece.to.x - piece.from.x, piece.to.y - piece.from.y, piece.to.z - piece.from.z);
      minutes_ += length / (piece.rapid || !(move.feed > 0) ? rapid : move.feed);
      add(piece.to, minutes_);
      move_.push_back(piece.move);
    }
  }

  std::size_t size() const { return pieces_.size(); }
  double minutes() const { return minutes_; }

  Json write(const PathPageData& data, ArrayWriter& arrays) const {
    PlaneWriter track;
    for (const std::vector<double>* values : {&x_, &y_, &z_, &time_}) track.doubles(*values);
    track.words(move_);
    PlaneWriter moves;
    std::vector<std::uint8_t> kind;
    std::vector<double> feed;
    std::vector<std::uint32_t> line;
    for (const Move& move : data.path->moves) kind.push_back(std::uint8_t(move.kind)), feed.push_back(move.feed);
    for (std::size_t l : data.line) line.push_back(std::uint32_t(l));
    moves.bytes(kind);
    moves.doubles(feed);
    moves.words(line);
    Json json;
    json["pieces"] = pieces_.size();
    json["moves"] = data.path->moves.size();
    json["minutes"] = minutes_;
    json["track"] = arrays.add(track.finish());
    json["moveTable"] = arrays.add(moves.finish());
    return json;
  }

 private:
  void add(Point3 p, double time) {
    x_.push_back(p.x), y_.push_back(p.y), z_.push_back(p.z);
    time_.push_back(time);
  }
  std::vector<Piece> pieces_;
  std::vector<double> x_, y_, z_, time_;
  std::vector<std::uint32_t> move_;
  double minutes_ = 0;
};

Json tool_json(const Cutter& cutter) {
  Json json;
  json["text"] = cutter.text();
  json["radius"] = cutter.radius();
  json["flat"] = cutter.flat_radius();
  json["corner"] = cutter.corner_radius();
  json["cornerEnd"] = cutter.corner_end();
  json["slope"] = std::isfinite(cutter.slope()) ? Json(cutter.slope()) : Json(nullptr);
  json["control"] = cutter.control_height();
  return json;
}

/// Heights relative to the origin, in single precision, which is what the page draws.
Json material_json(const Material& material, Point3 origin, ArrayWriter& arrays) {
  const Simulation& finished = material.finished;
  const auto packed = [&](const std::vector<double>& heights) {
    std::vector<std::uint32_t> words;
    for (double z : heights) words.push_back(std::bit_cast<std::uint32_t>(float(std::max(z - origin.z, beside_part))));
    PlaneWriter writer;
    writer.words(words);
    return arrays.add(writer.finish());
  };
  Json json;
  json["columns"] = finished.columns();
  json["rows"] = finished.rows();
  json["cell"] = finished.cell();
  json["first"] = {finished.place(0, 0).x - origin.x, finished.place(0, 0).y - origin.y};
  json["top"] = finished.stock_top() - origin.z;
  json["bottom"] = finished.stock_bottom() - origin.z;
  json["rest"] = finished.report().rest.value;
  json["gouge"] = finished.report().gouge.value;
  json["part"] = packed(finished.part());
  json["finished"] = packed(finished.left());
  json["before"] = material.before.empty() ? Json(nullptr) : Json(packed(material.before));
  std::vector<std::uint8_t> gouged;
  for (float depth : finished.gouge()) gouged.push_back(depth > 0 ? 1 : 0);
  PlaneWriter writer;
  writer.bytes(gouged);
  json["gouged"] = arrays.add(writer.finish());
  return json;
}

}  // namespace

Result<PathPage> render_path_page(const PathPageData& data, const Context& context) {
  if (*path_script == '\0')
    return Error{ErrorCode::usage, "this krepl was built without the page for tool paths", "",
                 "install nodejs and npm, and build again with -DKREPL_SURFACE_PAGE=ON"};
  const Material* const material = data.material;
  const Point3 origin = material != nullptr ? material->part->origin() : data.path->start;
  const double arc_error =
      material != nullptr ? material->finished.cell() * arc_error_of_cell : data.cutter.radius() * arc_error_of_radius;
  const Track track(data, origin, arc_error);
  if (track.size() >= std::size_t{1} << 31) return Error{ErrorCode::input, "the path has too many moves", "", "divide it"};

  std::string block;
  ArrayWriter arrays(block);
  Json json;
  json["title"] = data.title;
  json["unit"] = data.unit;
  json["radius"] = data.cutter.radius();
  json["origin"] = {origin.x, origin.y, origin.z};
  json["tool"] = tool_json(data.cutter);
  json["path"] = track.write(data, arrays);
  json["material"] = nullptr;
  json["layers"] = Json::array();
  if (material != nullptr) {
    json["material"] = material_json(*material, origin, arrays);
    LayerWriter layers(arrays, context);
    Result<Json> layer = layers.write(terrain_shape(*material->part, origin), "terrain");
    if (!layer) return layer.error();
    json["layers"].push_back(std::move(*layer));
  }
  block += "<script type=\"application/json\" id=\"page\">" + json_in_html(json) + "</script>";
  const std::string title = html_escaped(data.title);
  return PathPage{filled(path_template, {title, path_style, block, path_script}), track.size(), track.minutes()};
}

}  // namespace krepl::view
