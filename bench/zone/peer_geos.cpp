#include <geos_c.h>

#include "engines.hpp"
#include "geos_lines.hpp"

namespace bench {
namespace {

/// GEOS's buffer of a MultiLineString. It simplifies its input by radius / 100 first and cannot be told not to.
class Geos : public Engine {
 public:
  explicit Geos(const Task& task) : context_(GEOS_init_r()), radius_(task.radius) {
    input_ = multi_line(context_, task.lines);
    parameters_ = GEOSBufferParams_create_r(context_);
    const int quadrant_segments = (chords_of_circle(task.radius, task.chord_error) + 3) / 4;
    GEOSBufferParams_setQuadrantSegments_r(context_, parameters_, quadrant_segments);
  }
  Geos(const Geos&) = delete;
  Geos& operator=(const Geos&) = delete;
  ~Geos() override {
    GEOSGeom_destroy_r(context_, result_);
    GEOSGeom_destroy_r(context_, input_);
    GEOSBufferParams_destroy_r(context_, parameters_);
    GEOS_finish_r(context_);
  }

  bool run() override {
    GEOSGeom_destroy_r(context_, result_);
    result_ = GEOSBufferWithParams_r(context_, input_, parameters_, radius_);
    return result_ != nullptr;
  }

  Outcome outcome() const override {
    Outcome outcome;
    outcome.vertices = std::size_t(GEOSGetNumCoordinates_r(context_, result_));
    for (int i = 0; i < GEOSGetNumGeometries_r(context_, result_); ++i)
      outcome.holes += std::size_t(GEOSGetNumInteriorRings_r(context_, GEOSGetGeometryN_r(context_, result_, i)));
    GEOSArea_r(context_, result_, &outcome.area);
    return outcome;
  }

 private:
  GEOSContextHandle_t context_;
  double radius_;
  GEOSGeometry* input_ = nullptr;
  GEOSGeometry* result_ = nullptr;
  GEOSBufferParams* parameters_ = nullptr;
};

}  // namespace

std::unique_ptr<Engine> make_geos(const Task& task) { return std::make_unique<Geos>(task); }

}  // namespace bench
