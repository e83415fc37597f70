#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Segment_Delaunay_graph_2.h>
#include <CGAL/Segment_Delaunay_graph_filtered_traits_2.h>
#include <CGAL/Segment_Delaunay_graph_hierarchy_2.h>

#include <optional>

#include "diagrams.hpp"

namespace bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Traits = CGAL::Segment_Delaunay_graph_filtered_traits_without_intersections_2<Kernel>;
using Graph = CGAL::Segment_Delaunay_graph_hierarchy_2<Traits>;

class Cgal : public Builder {
 public:
  explicit Cgal(const Polylines& lines) {
    for (const auto& line : lines) {
      for (std::size_t k = 0; k < line.size(); ++k) {
        points_.emplace_back(line[k].x, line[k].y);
        if (k > 0) segments_.emplace_back(points_.size() - 2, points_.size() - 1);
      }
    }
  }
  /// All segments at once, which sorts the points along a space-filling curve: the quickest way there is.
  bool run() override {
    graph_.reset();
    graph_.emplace();
    graph_->insert_segments(points_.begin(), points_.end(), segments_.begin(), segments_.end());
    return true;
  }

 private:
  std::vector<Kernel::Point_2> points_;
  std::vector<std::pair<std::size_t, std::size_t>> segments_;
  std::optional<Graph> graph_;
};

}  // namespace

std::unique_ptr<Builder> make_cgal(const Polylines& lines) { return std::make_unique<Cgal>(lines); }

}  // namespace bench
