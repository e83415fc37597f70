#include <geos_c.h>

#include "engines.hpp"

namespace bench {
namespace {

/// GEOS's buffer of a MultiLineString. It simplifies its input by radius / 100 first and cannot be told not to.
class Geos : public Engine {
 public:
  explicit Geos(const Task& task) : context_(GEOS_init_r()), radius_(task.radius) {
    std::vector<GEOSGeometry*> lines;
    for (std::size_t i = 0; i < task.lines.count(); ++i) lines.push_back(line(task.lines, i));
    input_ = GEOSGeom_createCollection_r(context_, GEOS_MULTILINESTRING, lines.data(), unsigned(lines.size()));
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
  GEOSGeometry* result_ = nullptr;
  GEOSBufferParams* parameters_ = nullptr;
};

}  // namespace

std::unique_ptr<Engine> make_geos(const Task& task) { return std::make_unique<Geos>(task); }

}  // namespace bench
