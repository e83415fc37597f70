#include <cstdio>
#include <utility>

#include "engines.hpp"
#include "krepl/zone.hpp"

namespace bench {
namespace {

/// From coordinates in memory: cleaning and indexing the network is part of the operation.
class Krepl : public Engine {
 public:
  explicit Krepl(const Task& task) : task_(task) {}

  bool run() override {
    zone_.reset();
    const krepl::Context context{.threads = task_.threads, .progress = {}, .cancel = nullptr};
    krepl::Network::Builder builder;
    for (std::size_t i = 0; i < task_.lines.count(); ++i) {
      const std::size_t begin = task_.lines.begin[i], end = task_.lines.begin[i + 1];
      builder.add_line({task_.lines.points.data() + begin, end - begin});
    }
    auto network = std::move(builder).build(context);
    if (!network) return complain(network.error());
    auto shared = std::make_shared<const krepl::Network>(std::move(*network));
    auto zone = krepl::compute_zone(std::move(shared), {.radius = task_.radius}, context);
    if (!zone) return complain(zone.error());
    zone_ = std::move(*zone);
    return true;
  }

  Outcome outcome() const override { return {zone_->piece_count(), zone_->hole_count(), zone_->area()}; }

 private:
  static bool complain(const krepl::Error& error) {
    std::fprintf(stderr, "krepl: %s\n", error.text().c_str());
    return false;
  }
  Task task_;
  std::optional<krepl::Zone> zone_;
};

}  // namespace

std::unique_ptr<Engine> make_krepl(const Task& task) { return std::make_unique<Krepl>(task); }

}  // namespace bench
