#include <geos_c.h>

#include "ways.hpp"

namespace bench {
namespace {

/// The distance of points from a prepared MultiLineString: GEOS's tree over the facets of all lines.
class Geos : public Way {
 public:
  Geos(const Lines& lines, double radius, const std::vector<krepl::Point>& places) : context_(GEOS_init_r()), radius_(radius) {
    std::vector<GEOSGeometry*> parts;
    for (std::size_t i = 0; i < lines.count(); ++i) parts.push_back(line(lines, i));
    input_ = GEOSGeom_createCollection_r(context_, GEOS_MULTILINESTRING, parts.data(), unsigned(parts.size()));
    prepared_ = GEOSPrepare_r(context_, input_);
    for (const krepl::Point& p : places) places_.push_back(GEOSGeom_createPointFromXY_r(context_, p.x, p.y));
    double first = 0;  // the tree is made by the first question
    if (!places_.empty()) GEOSPreparedDistance_r(context_, prepared_, places_[0], &first);
  }
  Geos(const Geos&) = delete;
  Geos& operator=(const Geos&) = delete;
  ~Geos() override {
    for (GEOSGeometry* place : places_) GEOSGeom_destroy_r(context_, place);
    GEOSPreparedGeom_destroy_r(context_, prepared_);
    GEOSGeom_destroy_r(context_, input_);
    GEOS_finish_r(context_);
  }

  bool run(std::vector<double>& clearances) override {
    for (std::size_t i = 0; i < places_.size(); ++i) {
      double distance = 0;
      if (GEOSPreparedDistance_r(context_, prepared_, places_[i], &distance) != 1) return false;
      clearances[i] = distance - radius_;
    }
    return true;
  }

 private:
  GEOSGeometry* line(const Lines& lines, std::size_t i) {
    const std::size_t begin = lines.begin[i], end = lines.begin[i + 1];
    GEOSCoordSequence* sequence = GEOSCoordSeq_create_r(context_, unsigned(end - begin), 2);
    for (std::size_t j = begin; j < end; ++j)
      GEOSCoordSeq_setXY_r(context_, sequence, unsigned(j - begin), lines.points[j].x, lines.points[j].y);
    return GEOSGeom_createLineString_r(context_, sequence);
  }

  GEOSContextHandle_t context_;
  double radius_;
  GEOSGeometry* input_ = nullptr;
  const GEOSPreparedGeometry* prepared_ = nullptr;
  std::vector<GEOSGeometry*> places_;
};

}  // namespace

std::unique_ptr<Way> make_geos(const Lines& lines, double radius, const std::vector<krepl::Point>& places) {
  return std::make_unique<Geos>(lines, radius, places);
}

}  // namespace bench
