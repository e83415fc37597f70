#include <cstdio>
#include <optional>

#include "../measure.hpp"
#include "diagrams.hpp"
#include "krepl/voronoi.hpp"

namespace bench {
namespace {

/// Cleaning and indexing the network is part of the operation.
class Krepl : public Builder {
 public:
  explicit Krepl(const Polylines& lines) : lines_(lines) {}

  bool run() override {
    diagram_.reset();
    krepl::Network::Builder builder;
    for (const auto& line : lines_) builder.add_line(line);
    auto network = std::move(builder).build(context_);
    if (!network) return complain(network.error());
    auto diagram = krepl::VoronoiDiagram::build(std::make_shared<const krepl::Network>(std::move(*network)), context_);
    if (!diagram) return complain(diagram.error());
    diagram_.emplace(std::move(*diagram));
    return true;
  }

  /// Zones out of the diagram at ten radii between 0.2 and 2 mean segment lengths.
  std::string more() override {
    const krepl::Network& network = diagram_->network();
    double length = 0;
    for (const auto s : network.segments())
      length += std::hypot(network.vertices()[s.a].x - network.vertices()[s.b].x,
                           network.vertices()[s.a].y - network.vertices()[s.b].y);
    const double n = double(network.segments().size()), mean = length / n;
    constexpr int radii = 10;
    const double start = cpu_seconds();
    for (int i = 1; i <= radii; ++i)
      if (!diagram_->zone({0.2 * i * mean}, context_)) return {};
    const double each = (cpu_seconds() - start) / radii;
    const auto& c = diagram_->counters();
    char text[200];
    std::snprintf(text, sizeof text, ", \"faces\": %llu, \"again\": %llu, \"candidates\": %llu, \"radius\": %.9g",
                  static_cast<unsigned long long>(c.faces), static_cast<unsigned long long>(c.faces_in_pairs),
                  static_cast<unsigned long long>(c.candidates), each);
    return text;
  }

 private:
  static bool complain(const krepl::Error& error) {
    std::fprintf(stderr, "krepl: %s\n", error.text().c_str());
    return false;
  }
  const Polylines& lines_;
  const krepl::Context context_{.threads = 1, .progress = {}, .cancel = nullptr};
  std::optional<krepl::VoronoiDiagram> diagram_;
};

}  // namespace

std::unique_ptr<Builder> make_krepl(const Polylines& lines) { return std::make_unique<Krepl>(lines); }

}  // namespace bench
