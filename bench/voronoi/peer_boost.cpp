#include <boost/polygon/point_data.hpp>
#include <boost/polygon/segment_concept.hpp>
#include <boost/polygon/segment_data.hpp>
#include <boost/polygon/voronoi.hpp>

#include "diagrams.hpp"

namespace bench {
namespace {

class Boost : public Builder {
 public:
  explicit Boost(const Polylines& lines) {
    using boost::polygon::point_data;
    for (const auto& line : lines)
      for (std::size_t k = 0; k + 1 < line.size(); ++k)
        input_.emplace_back(point_data<int>(int(line[k].x), int(line[k].y)),
                            point_data<int>(int(line[k + 1].x), int(line[k + 1].y)));
  }
  bool run() override {
    diagram_.clear();
    boost::polygon::construct_voronoi(input_.begin(), input_.end(), &diagram_);
    return true;
  }

 private:
  std::vector<boost::polygon::segment_data<int>> input_;
  boost::polygon::voronoi_diagram<double> diagram_;
};

}  // namespace

std::unique_ptr<Builder> make_boost(const Polylines& lines) { return std::make_unique<Boost>(lines); }

}  // namespace bench
