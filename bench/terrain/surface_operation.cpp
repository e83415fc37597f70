#include <cstdio>
#include <optional>

#include "krepl/surface.hpp"
#include "operations.hpp"

namespace bench {
namespace {

class SurfaceOperation : public Operation {
 public:
  explicit SurfaceOperation(const Task& task) : task_(task) {}

  bool run() override {
    surface_.reset();
    auto surface = krepl::compute_surface(task_.terrain, {.radius = task_.radius}, task_.context());
    if (!surface) return std::fprintf(stderr, "krepl: %s\n", surface.error().text().c_str()), false;
    surface_ = std::move(*surface);
    return true;
  }

  std::string facts() const override {
    const krepl::Subdivision& s = surface_->subdivision();
    char text[200];
    std::snprintf(text, sizeof text, ", \"vertices\": %zu, \"edges\": %zu, \"faces\": %zu", s.vertex_count,
                  s.edge_count(), s.face_count());
    return text;
  }

 private:
  Task task_;
  std::optional<krepl::Surface> surface_;
};

}  // namespace

std::unique_ptr<Operation> make_surface(const Task& task) { return std::make_unique<SurfaceOperation>(task); }

}  // namespace bench
