#include "input/motion_stream.hpp"

#include <cmath>
#include <utility>

#include "input/geometry_source.hpp"
#include "input/place_stream.hpp"

namespace krepl::input {

namespace {

constexpr std::size_t portion = 65536;  // points

void begin_motion(Motions& motions, std::string name) {
  motions.begin.push_back(motions.points.size());
  motions.name.push_back(std::move(name));
}

}  // namespace

class MotionStream::Source {
 public:
  virtual ~Source() = default;
  /// Adds whole motions until there are `portion` points or no more; `begin` gets its end by the caller.
  virtual Status add(Motions& motions, const Context& context) = 0;
};

/// CSV. A motion goes on until the text of its column changes, which only the next row tells.
class MotionStream::Rows : public Source {
 public:
  explicit Rows(PlaceStream places) : places_(std::move(places)) {}

  Status add(Motions& motions, const Context& context) override {
    for (;;) {
      for (; at_ < places_read_.size(); ++at_) {
        const std::string& name = places_.has_labels() ? labels_[at_] : only_;
        if (motions.name.empty() || motions.name.back() != name) {
          if (motions.points.size() >= portion) return std::monostate{};
          begin_motion(motions, name);
        }
        motions.points.push_back(places_read_[at_]);
      }
      at_ = 0;
      if (Status got = places_.next(places_read_, labels_, context); !got) return got;
      if (places_read_.empty()) return std::monostate{};
    }
  }

 private:
  PlaceStream places_;
  std::vector<Point3> places_read_;
  std::vector<std::string> labels_;
  std::size_t at_ = 0;
  const std::string only_ = "1";
};

/// Lines of a vector file.
class MotionStream::Lines : public Source {
 public:
  Lines(std::unique_ptr<GeometrySource> source, bool with_z) : source_(std::move(source)), with_z_(with_z) {}

  Status add(Motions& motions, const Context& context) override {
    while (motions.points.size() < portion) {
      if (context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
      auto item = source_->next();
      if (!item) return item.error();
      if (!item->has_value()) {
        if (const auto crs = source_->crs(); crs && crs->IsGeographic())
          return Error{ErrorCode::input, "has coordinates in degrees", "", "project it to where IN is, as with ogr2ogr -t_srs"};
        if (!any_) return Error{ErrorCode::input, "has no motions", "", "give lines"};
        return std::monostate{};
      }
      const GeometrySource::Item& record = **item;
      if (record.geometry == nullptr || record.geometry->IsEmpty()) continue;
      if (Status added = add(*record.geometry, record.number, motions); !added) return added;
      any_ = true;
    }
    return std::monostate{};
  }

 private:
  Status add(const OGRGeometry& geometry, std::int64_t number, Motions& motions) {
    const std::string name = std::to_string(number);
    if (wkbFlatten(geometry.getGeometryType()) != wkbMultiLineString) return add_line(geometry, number, name, motions);
    int part = 0;
    for (const OGRLineString* line : *geometry.toMultiLineString())
      if (Status added = add_line(*line, number, name + "." + std::to_string(++part), motions); !added) return added;
    return std::monostate{};
  }

  Status add_line(const OGRGeometry& geometry, std::int64_t number, const std::string& name, Motions& motions) {
    const auto type = wkbFlatten(geometry.getGeometryType());
    const std::string place = source_->place(number);
    if (type == wkbPoint) {  // a motion that stays where it is
      const OGRPoint& point = *geometry.toPoint();
      begin_motion(motions, name);
      return add_point({point.getX(), point.getY(), point.getZ()}, geometry.Is3D(), place, motions);
    }
    if (type != wkbLineString)
      return Error{ErrorCode::input, std::string("geometry of type ") + geometry.getGeometryName() + " is not a motion", place,
                   "give lines of straight pieces"};
    const OGRLineString& line = *geometry.toLineString();
    begin_motion(motions, name);
    for (int i = 0; i < line.getNumPoints(); ++i)
      if (Status added = add_point({line.getX(i), line.getY(i), line.getZ(i)}, geometry.Is3D(), place, motions); !added)
        return added;
    return std::monostate{};
  }

  Status add_point(Point3 p, bool has_z, const std::string& place, Motions& motions) const {
    if (with_z_ && !has_z)
      return Error{ErrorCode::input, "the motion has no heights", place, "over a terrain give lines with Z"};
    if (!with_z_) p.z = 0;
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      return Error{ErrorCode::input, "a coordinate is not finite", place, ""};
    motions.points.push_back(p);
    return std::monostate{};
  }

  std::unique_ptr<GeometrySource> source_;
  bool with_z_, any_ = false;
};

MotionStream::MotionStream(std::unique_ptr<Source> source) : source_(std::move(source)) {}
MotionStream::MotionStream(MotionStream&&) noexcept = default;
MotionStream& MotionStream::operator=(MotionStream&&) noexcept = default;
MotionStream::~MotionStream() = default;

Result<MotionStream> MotionStream::open(const std::string& path, bool with_z, const std::string& layer,
                                        const std::string& where, const Context& context) {
  const std::string extension = format_extension(path);
  if (path == "-" || extension == "csv" || extension == "txt") {
    if (!layer.empty() || !where.empty())
      return Error{ErrorCode::usage, "motions in a CSV have no layers", "", "leave out --motion-layer and --motion-where"};
    Result<PlaceStream> places = PlaceStream::open(path, with_z, context, "motion");
    if (!places) return places.error();
    return MotionStream(std::make_unique<Rows>(std::move(*places)));
  }
  auto source = open_geometry_source(path, {layer, where}, context);
  if (!source) return source.error();
  return MotionStream(std::make_unique<Lines>(std::move(*source), with_z));
}

Status MotionStream::next(Motions& motions, const Context& context) {
  motions.points.clear(), motions.begin.clear(), motions.name.clear();
  if (Status added = source_->add(motions, context); !added) return added;
  motions.begin.push_back(motions.points.size());
  return std::monostate{};
}

}  // namespace krepl::input
