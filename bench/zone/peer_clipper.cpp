#include <algorithm>
#include <cmath>
#include <polyclipping/clipper.hpp>

#include "engines.hpp"

namespace bench {
namespace {

namespace cl = ClipperLib;

/// Clipper 6 works on integers: one unit is a tenth of the chord error asked for, so that rounding does not count.
class Clipper : public Engine {
 public:
  explicit Clipper(const Task& task)
      : unit_(task.chord_error / 10), offset_(2.0, task.chord_error / unit_), radius_(task.radius / unit_) {
    const krepl::Point origin = task.lines.points.front();
    for (std::size_t i = 0; i < task.lines.count(); ++i) {
      cl::Path path;
      for (std::size_t j = task.lines.begin[i]; j < task.lines.begin[i + 1]; ++j)
        path.emplace_back(units(task.lines.points[j].x - origin.x), units(task.lines.points[j].y - origin.y));
      offset_.AddPath(path, cl::jtRound, cl::etOpenRound);
    }
  }

  bool run() override {
    result_.clear();
    offset_.Execute(result_, radius_);
    return !result_.empty();
  }

  Outcome outcome() const override {
    Outcome outcome;
    for (const cl::Path& path : result_) {
      const double area = cl::Area(path) * unit_ * unit_;
      outcome.vertices += path.size();
      outcome.holes += area < 0;
      outcome.area += area;
    }
    return outcome;
  }

 private:
  cl::cInt units(double length) const { return cl::cInt(std::llround(length / unit_)); }

  double unit_;
  cl::ClipperOffset offset_;
  double radius_;
  cl::Paths result_;
};

}  // namespace

std::unique_ptr<Engine> make_clipper(const Task& task) { return std::make_unique<Clipper>(task); }

}  // namespace bench
