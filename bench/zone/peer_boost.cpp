#include <boost/geometry.hpp>
#include <boost/geometry/geometries/geometries.hpp>
#include <boost/geometry/geometries/point_xy.hpp>

#include "engines.hpp"

namespace bench {
namespace {

namespace bg = boost::geometry;
using BoostPoint = bg::model::d2::point_xy<double>;
using BoostPolygon = bg::model::polygon<BoostPoint>;

class Boost : public Engine {
 public:
  explicit Boost(const Task& task)
      : radius_(task.radius), points_per_circle_(std::size_t(chords_of_circle(task.radius, task.chord_error))) {
    for (std::size_t i = 0; i < task.lines.count(); ++i) {
      auto& line = input_.emplace_back();
      for (std::size_t j = task.lines.begin[i]; j < task.lines.begin[i + 1]; ++j)
        line.emplace_back(task.lines.points[j].x, task.lines.points[j].y);
    }
  }

  bool run() override {
    namespace strategy = bg::strategy::buffer;
    result_.clear();
    bg::buffer(input_, result_, strategy::distance_symmetric<double>(radius_), strategy::side_straight(),
               strategy::join_round(points_per_circle_), strategy::end_round(points_per_circle_),
               strategy::point_circle(points_per_circle_));
    return !result_.empty();
  }

  Outcome outcome() const override {
    Outcome outcome{bg::num_points(result_), 0, bg::area(result_)};
    for (const auto& polygon : result_) outcome.holes += polygon.inners().size();
    return outcome;
  }

 private:
  double radius_;
  std::size_t points_per_circle_;
  bg::model::multi_linestring<bg::model::linestring<BoostPoint>> input_;
  bg::model::multi_polygon<BoostPolygon> result_;
};

}  // namespace

std::unique_ptr<Engine> make_boost(const Task& task) { return std::make_unique<Boost>(task); }

}  // namespace bench
