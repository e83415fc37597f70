#include <geos_c.h>

#include "../zone/geos_lines.hpp"
#include "ways.hpp"

namespace bench {
namespace {

/// The distance of points from a prepared MultiLineString: GEOS's tree over the facets of all lines.
class Geos : public Way {
 public:
  Geos(const Lines& lines, double radius, const std::vector<krepl::Point>& places) : context_(GEOS_init_r()), radius_(radius) {
    input_ = multi_line(context_, lines);
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
