// The streaming run: the same sweep, with a sink behind it.
#include "profile/check.hpp"
#include "profile/sweep.hpp"

namespace krepl {

using profile::Sweep;

struct ProfileStream::State {
  Sweep sweep;
  double radius = 0;
  Sink sink;
  std::uint64_t vertices = 0;
  bool failed = false;
  std::vector<ProfileRow> rows;

  auto writer() {
    return [this](ProfilePiece::Kind kind, std::uint32_t index, Point center, Point start, Point end) {
      constexpr double none = std::numeric_limits<double>::quiet_NaN();
      rows.push_back({kind, start, end, kind == ProfilePiece::Kind::arc ? center : Point{none, none}, index});
    };
  }
  void deliver() {
    if (rows.empty()) return;
    sink(rows);
    rows.clear();
  }
  Status append(const Point* points, std::size_t count);
};

Status ProfileStream::State::append(const Point* points, std::size_t count) {
  if (vertices + count > profile::most_vertices) return profile::too_many_vertices_error();
  const Point before = sweep.last_vertex();
  const std::size_t taken = sweep.append(points, count, std::uint32_t(vertices));
  sweep.settle(writer());
  deliver();
  vertices += taken;
  if (taken == count) return std::monostate{};
  return profile::vertex_error(vertices, points[taken], taken > 0 ? &points[taken - 1] : &before);
}

ProfileStream::ProfileStream(std::unique_ptr<State> state) : state_(std::move(state)) {}
ProfileStream::~ProfileStream() = default;
ProfileStream::ProfileStream(ProfileStream&&) noexcept = default;
ProfileStream& ProfileStream::operator=(ProfileStream&&) noexcept = default;

Result<ProfileStream> ProfileStream::open(double radius, Sink sink) {
  if (Status status = profile::check_radius(radius); !status) return status.error();
  auto state = std::make_unique<State>();
  state->radius = radius;
  state->sink = std::move(sink);
  return ProfileStream(std::move(state));
}

Status ProfileStream::push(std::span<const Point> points) {
  State& s = *state_;
  if (s.failed) return Error{ErrorCode::usage, "the stream has failed before", "", "open a new one"};
  if (s.vertices == 0 && !points.empty()) {
    if (!profile::usable(points[0])) {
      s.failed = true;
      return profile::vertex_error(0, points[0], nullptr);
    }
    s.sweep.start(s.radius, points[0], 0, false);
    s.vertices = 1;
    points = points.subspan(1);
  }
  while (!points.empty()) {
    const std::size_t count = std::min(Sweep::batch, points.size());
    if (Status status = s.append(points.data(), count); !status) {
      s.failed = true;
      return status;
    }
    points = points.subspan(count);
  }
  return std::monostate{};
}

Status ProfileStream::finish() {
  State& s = *state_;
  if (s.failed) return Error{ErrorCode::usage, "the stream has failed before", "", "open a new one"};
  if (s.vertices == 0) return profile::no_vertex_error();
  s.sweep.finish(s.writer());
  s.deliver();
  s.failed = true;
  return std::monostate{};
}

const ProfileCounters& ProfileStream::counters() const { return state_->sweep.counters(); }

}  // namespace krepl
