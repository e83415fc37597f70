#include "terrain/envelope.hpp"

#include <algorithm>

namespace krepl::terrain {

using FeatureKind = Terrain::FeatureKind;

Range operator*(Range a, Range b) {
  const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
  return {std::min({p, q, r, s}), std::max({p, q, r, s})};
}

struct Envelope::Line {
  bool vertical;
  double at;
  Point point(double t) const { return vertical ? Point{at, t} : Point{t, at}; }
  Box box(double t0, double t1) const { return {point(t0), point(t1)}; }
};

Envelope::Envelope(const PatchSet& patches, double scale, SurfaceCounters& counters)
    : patches_(patches),
      tolerance_(0x1p-40 * scale),
      smallest_cell_(0x1p-36 * scale),
      smallest_stretch_(0x1p-50 * scale),
      noise_(0x1p-49 * scale),
      rim_width_(2 * tolerance_),
      counters_(counters) {}

Index Envelope::winner(Point p, std::span<const Index> candidates) const {
  // What rounding alone tells apart counts as equal: of coplanar triangles one over the other, both would show here and there.
  Index best = none;
  double highest = below_everything;
  counters_.height_evaluations += candidates.size();
  const auto comes_first = [&](Index c, Index d) {
    const Patch &f = patches_[c], &g = patches_[d];
    return f.kind != g.kind ? f.kind > g.kind : f.feature < g.feature;  // face, edge, vertex
  };
  for (const Index c : candidates) {
    if (!patches_.contains(c, p)) continue;
    const double h = patches_.extended_height(c, p);
    if (best == none || h > highest + noise_) {
      best = c;
      highest = h;
    } else if (h >= highest - noise_) {
      if (comes_first(c, best)) best = c;
      highest = std::max(highest, h);
    }
  }
  return best;
}

struct Envelope::BoxFrame {
  explicit BoxFrame(const Box& b) : box(b), mid(b.middle()), hx(b.half_x()), hy(b.half_y()) {}
  const Box& box;
  Point mid;
  double hx, hy;
};

/// The least value of a bound's function over a box (sign = 1), or the greatest one with its sign changed (sign = -1), a bit
/// less for rounding.
template <int sign>
inline double Envelope::extreme(const Bound& b, const BoxFrame& f) const {
  const double dx = f.mid.x - b.at.x, dy = f.mid.y - b.at.y;
  const double slack = 1e-15 * (std::fabs(dx) + std::fabs(dy) + f.hx + f.hy);
  if (b.type == Bound::Type::line) {
    return sign * (dx * b.nx + dy * b.ny - b.c) - (std::fabs(b.nx) * f.hx + std::fabs(b.ny) * f.hy + slack);
  }
  const double square = patches_.square_radius();
  const double near_x = std::max(0.0, std::fabs(dx) - f.hx), near_y = std::max(0.0, std::fabs(dy) - f.hy);
  const double far_x = std::fabs(dx) + f.hx, far_y = std::fabs(dy) + f.hy;
  const double near = near_x * near_x + near_y * near_y, far = far_x * far_x + far_y * far_y;
  if (b.type == Bound::Type::disc) return (sign > 0 ? near - square : square - far) - 2 * slack * (far_x + far_y);
  const double lift = sign * b.c, up = std::sqrt(std::max(0.0, square - (lift >= 0 ? far : near)));
  return sign * (dx * b.nx + dy * b.ny) - (std::fabs(b.nx) * f.hx + std::fabs(b.ny) * f.hy + slack) + lift * up;
}

/// True if the patch's side of the bound is all of the box.
inline bool Envelope::is_within(const Bound& b, const BoxFrame& f) const {
  return b.negative ? extreme<-1>(b, f) > 0 : extreme<1>(b, f) >= 0;
}

Range Envelope::bound_range(const Bound& b, const Box& box) const {
  const BoxFrame frame(box);
  return {extreme<1>(b, frame), -extreme<-1>(b, frame)};
}

/// Of a patch whose bounding rectangle meets the box.
inline bool Envelope::domain_meets(Index i, const BoxFrame& box) const {
  for (const Bound& b : patches_.bounds(i)) {
    // Where a patch ends in a wall, what reaches into the box by less than matters is left out: two walls can be tangent.
    const double slack = !b.rim ? 0 : b.type == Bound::Type::disc ? 2 * patches_.radius() * tolerance_ : tolerance_;
    if (b.negative ? extreme<1>(b, box) >= -slack : extreme<-1>(b, box) > -slack) return false;
  }
  return true;
}

/// Where a tangent plane bounds the patch well over a box of the given size: in its middle, but not closer to the rim than that.
inline Point Envelope::support_point(Index i, Point mid, double size) const {
  const Patch& f = patches_[i];
  if (f.kind == FeatureKind::face) return mid;
  const double radius = patches_.radius(), most = radius - std::min(size, radius / 2);
  const double dx = mid.x - f.at.x, dy = mid.y - f.at.y;
  if (f.kind == FeatureKind::vertex) {
    const double square = dx * dx + dy * dy;
    if (square <= most * most) return mid;
    const double s = most / std::sqrt(square);
    return {f.at.x + s * dx, f.at.y + s * dy};
  }
  const double aside = dy * f.gx - dx * f.gy;
  if (std::fabs(aside) <= most) return mid;
  const double shift = (aside > 0 ? most : -most) - aside;
  return {mid.x - shift * f.gy, mid.y + shift * f.gx};
}

/// The tangent plane at the support point, as its height in the middle and its slope.
inline Envelope::Tangent Envelope::tangent(Index i, Point mid, double size) const {
  const Patch& f = patches_[i];
  if (f.kind == FeatureKind::face) return {f.z + (f.gx * (mid.x - f.at.x) + f.gy * (mid.y - f.at.y)), {f.gx, f.gy}};
  const Point p = support_point(i, mid, size);
  const Gradient g = patches_.gradient(i, p);
  return {patches_.extended_height(i, p) + g.x * (mid.x - p.x) + g.y * (mid.y - p.y), g};
}

bool Envelope::domain_covers(Index i, const BoxFrame& box) const {
  for (const Bound& b : patches_.bounds(i)) {
    if (!is_within(b, box)) return false;
  }
  return true;
}

/// The one wall at which the patch ends within the box, if it covers the box otherwise: there it is at least as high as its rim.
const Bound* Envelope::wall_through(Index i, const BoxFrame& box) const {
  const Bound* wall = nullptr;
  for (const Bound& b : patches_.bounds(i)) {
    if (is_within(b, box)) continue;
    if (!b.rim || wall != nullptr) return nullptr;
    wall = &b;
  }
  return wall;
}

const Bound* Envelope::wall_above(Index upper, Index lower, const Box& box) const {
  const Bound* wall = wall_through(upper, BoxFrame(box));
  if (wall == nullptr) return nullptr;
  const Point mid = box.middle(), p = support_point(lower, mid, box.larger_side());
  const Gradient g = patches_.gradient(lower, p);
  for (const Point q : {box.low, Point{box.high.x, box.low.y}, box.high, Point{box.low.x, box.high.y}}) {
    if (!(patches_.extended_height(lower, p) + g.x * (q.x - p.x) + g.y * (q.y - p.y) < rim_height(upper, q) - noise_)) return nullptr;
  }
  return wall;
}

/// True if the patch lies on the inner side of another one's wall within the box, as far as matters.
bool Envelope::ends_before(Index i, const Bound& wall, const Box& box) const {
  const Patch& f = patches_[i];
  const double tolerance = tolerance_ / 4;
  if (wall.type == Bound::Type::line) {
    for (const Bound& b : patches_.bounds(i)) {  // its own straight side runs along the wall
      if (b.type != Bound::Type::line) continue;
      const double s = (b.negative ? -1 : 1), w = (wall.negative ? -1 : 1);
      const Point m = box.middle();
      const double excess = s * b.value(m, 0) - w * wall.value(m, 0);
      const double spread = std::fabs(s * b.nx - w * wall.nx) * box.half_x() + std::fabs(s * b.ny - w * wall.ny) * box.half_y();
      if (excess + spread <= tolerance) return true;
    }
  }
  if (wall.type == Bound::Type::disc) {
    return f.kind == FeatureKind::vertex && std::hypot(f.at.x - wall.at.x, f.at.y - wall.at.y) <= tolerance;
  }
  const auto beyond = [&](Point p) {  // of the edge's line, towards the wall
    const double aside = (p.x - wall.at.x) * wall.nx + (p.y - wall.at.y) * wall.ny;
    return wall.negative ? aside : -aside;
  };
  if (f.kind == FeatureKind::vertex) return beyond(f.at) <= tolerance;
  if (f.kind == FeatureKind::edge) {
    return beyond(f.at) <= tolerance && beyond({f.at.x + f.length * f.gx, f.at.y + f.length * f.gy}) <= tolerance;
  }
  for (const Point c : patches_.corners(i)) {
    if (beyond(c) > patches_.radius() + tolerance) return false;
  }
  return true;
}

/// Two edges above each other or in one line, as seen from above: the difference of their heights is linear in the place along
/// them and in the root that both share, so its least value is at an end.
bool Envelope::hidden_in_line(Index lower, Index upper, const BoxFrame& frame) const {
  const Patch &c = patches_[lower], &k = patches_[upper];
  if (c.kind != FeatureKind::edge || k.kind != FeatureKind::edge) return false;
  if (std::fabs(c.gx * k.gy - c.gy * k.gx) > 1e-13) return false;
  const auto aside = [](const Patch& f, Point p) { return (p.y - f.at.y) * f.gx - (p.x - f.at.x) * f.gy; };
  const double turn = c.gx * k.gx + c.gy * k.gy > 0 ? 1 : -1;
  const double beta = aside(k, frame.mid);
  if (std::fabs(beta - turn * aside(c, frame.mid)) > tolerance_ / 4) return false;
  const std::span<const Bound> sides = patches_.bounds(upper);
  for (const Bound& b : sides) {
    if (b.type == Bound::Type::cone && !is_within(b, frame)) return false;
  }
  const double spread = std::fabs(k.gx) * frame.hy + std::fabs(k.gy) * frame.hx, square = patches_.square_radius();
  const double near = std::max(0.0, std::fabs(beta) - spread), far = std::fabs(beta) + spread;
  const double up[2] = {std::sqrt(std::max(0.0, square - far * far)), std::sqrt(std::max(0.0, square - near * near))};
  const Box& box = frame.box;
  for (const Point p : {box.low, Point{box.high.x, box.low.y}, box.high, Point{box.low.x, box.high.y}}) {
    const double level = rim_height(upper, p) - rim_height(lower, p);
    for (const double u : up) {
      if (!(level + (k.q - c.q) * u > noise_)) return false;
    }
  }
  return true;
}

/// True if nothing that the ball touches with the lower patch rises above the upper one's plane: then the lower patch does not rise
/// above the plane moved by R, however tangent to it.
bool Envelope::hidden_below_face(Index lower, Index upper, const BoxFrame& frame) const {
  const Patch &c = patches_[lower], &k = patches_[upper];
  if (k.kind != FeatureKind::face || c.kind == FeatureKind::face) return false;
  const double plane = k.z - patches_.radius() * k.q, slack = noise_ * k.q;  // the plane through the triangle
  const auto above = [&](double x, double y, double z) {
    return z - (plane + k.gx * (x - k.at.x) + k.gy * (y - k.at.y)) > slack;
  };
  if (above(c.at.x, c.at.y, c.z)) return false;
  if (c.kind == FeatureKind::edge && above(c.at.x + c.length * c.gx, c.at.y + c.length * c.gy, c.z + c.m * c.length)) return false;
  return domain_covers(upper, frame);
}

/// True if two straight walls run along each other in the box, each with its patch on its own side and no gap between.
bool Envelope::back_to_back(const Bound& a, const Bound& b, const Box& box) const {
  if (a.type != Bound::Type::line || b.type != Bound::Type::line) return false;
  const double s = a.negative ? 1 : -1, t = b.negative ? 1 : -1;  // the values times these are negative inside
  const Point m = box.middle();
  const double spread = std::fabs(s * a.nx + t * b.nx) * box.half_x() + std::fabs(s * a.ny + t * b.ny) * box.half_y();
  return s * a.value(m, 0) + t * b.value(m, 0) + spread <= tolerance_ / 4;
}

/// The bodies of a few labels over a box, evaluated at its corners as far as needed: a concave height is least at a corner, less
/// a plane too.
class Envelope::Cover {
 public:
  Cover(const Envelope& envelope, const BoxFrame& frame, std::span<const Index> labels)
      : envelope_(envelope), frame_(frame), bodies_(labels.size()) {
    const Box& box = frame.box;
    corner_[0] = box.low;
    corner_[1] = {box.high.x, box.low.y};
    corner_[2] = box.high;
    corner_[3] = {box.low.x, box.high.y};
    if (box.low.x == box.high.x || box.low.y == box.high.y) step_ = 2;
    for (std::size_t k = 0; k < bodies_; ++k) body_[k].label = labels[k];
  }

  /// True if the patch, which lies below the given plane, is nowhere seen.
  bool hides(Index c, const Tangent& plane) {
    const double hx = plane.slope.x * frame_.hx, hy = plane.slope.y * frame_.hy, h = plane.height;
    const double t[4] = {h - hx - hy, h + hx - hy, h + hx + hy, h - hx + hy};
    const int highest = step_ == 2 ? (hx + hy > 0 ? 2 : 0) : hy > 0 ? (hx > 0 ? 2 : 3) : (hx > 0 ? 1 : 0);
    if (hides(c, t, highest)) return true;
    // Faces that are nearly vertical have a top, but no tangent plane worth having.
    const double top = envelope_.patches_[c].top;
    if (!(top < t[highest])) return false;
    const double level[4] = {top, top, top, top};
    return below_one(c, masks(level, highest));
  }

 private:
  static constexpr std::size_t most = 4;
  using Masks = std::array<unsigned, most>;  // per body: at which corners it is higher
  struct Body {
    Index label;
    const Bound* wall = nullptr;  // where the body ends within the box
    double height[4];             // with a wall: of its rim
    unsigned known = 0;
    bool ends = false;
    enum class Covers : std::uint8_t { unknown, no, yes } covers = Covers::unknown;
  };

  unsigned all_corners() const { return step_ == 1 ? 15 : 5; }

  bool is_above(Body& b, int i, double t) {
    if ((b.known >> i & 1) == 0) {
      b.height[i] = envelope_.patches_.body_height(b.label, corner_[i]);
      b.known |= 1u << i;
      if (!(b.height[i] > below_everything)) end_at_wall(b);
    }
    if (b.height[i] - envelope_.noise_ > t) return true;
    if (b.ends || !(b.height[i] + envelope_.noise_ > t)) return false;
    // A patch over all of the box may hide what sticks out by less than matters. One that is not might be hidden itself, as
    // part of another's body, by what it would hide: then only what is clearly lower.
    if (b.covers == Body::Covers::unknown) {
      b.covers = envelope_.domain_covers(b.label, frame_) ? Body::Covers::yes : Body::Covers::no;
    }
    return b.covers == Body::Covers::yes;
  }

  void end_at_wall(Body& b) {
    b.wall = envelope_.wall_through(b.label, frame_);
    b.ends = true;
    b.known = 15;
    for (int i = 0; i < 4; ++i) b.height[i] = b.wall != nullptr ? envelope_.rim_height(b.label, corner_[i]) : below_everything;
  }

  /// Without any bit if no body is higher at some corner.
  Masks masks(const double (&t)[4], int first) {
    Masks m{};
    for (int n = 0; n < 4; n += step_) {
      const int i = (first + n) & 3;
      bool any = false;
      for (std::size_t k = 0; k < bodies_; ++k) {
        Body& b = body_[k];
        const bool ended = b.ends;
        if (is_above(b, i, t[i])) m[k] |= 1u << i;
        if (b.ends != ended) {
          for (int before = 0; before < n; before += step_) {
            const int j = (first + before) & 3;
            m[k] &= ~(1u << j);
            if (is_above(b, j, t[j])) m[k] |= 1u << j;
          }
        }
        any = any || (m[k] >> i & 1) != 0;
      }
      if (!any) return {};
    }
    return m;
  }

  bool below_one(Index c, const Masks& m) const {
    for (std::size_t k = 0; k < bodies_; ++k) {
      if (m[k] != all_corners()) continue;
      if (body_[k].wall == nullptr || envelope_.ends_before(c, *body_[k].wall, frame_.box)) return true;
    }
    return false;
  }

  bool hides(Index c, const double (&t)[4], int highest) {
    const Masks m = masks(t, highest);
    if (below_one(c, m)) return true;
    for (std::size_t k = 0; k < bodies_; ++k) {
      for (std::size_t l = k + 1; l < bodies_; ++l) {
        if ((m[k] | m[l]) != all_corners()) continue;
        const Body &a = body_[k], &b = body_[l];
        if (!a.ends && !b.ends && below_mean(a, b, t)) return true;
        // Two walls back to back: one of the bodies is there at every place.
        if (m[k] == m[l] && a.wall != nullptr && b.wall != nullptr && envelope_.back_to_back(*a.wall, *b.wall, frame_.box)) {
          return true;
        }
      }
    }
    return false;
  }

  /// Below a weighted mean of two bodies, which is concave too and not above the higher one.
  bool below_mean(const Body& a, const Body& b, const double (&t)[4]) const {
    double low = 0, high = 1;
    for (int i = 0; i < 4; i += step_) {
      const double slope = a.height[i] - b.height[i], need = t[i] + envelope_.noise_ - b.height[i];
      if (slope > 0) low = std::max(low, need / slope);
      else if (slope < 0) high = std::min(high, need / slope);
      else if (need >= 0) return false;
    }
    return low < high;
  }

  const Envelope& envelope_;
  const BoxFrame& frame_;
  std::size_t bodies_;
  int step_ = 1;  // a line has two ends
  Point corner_[4];
  Body body_[most];
};

void Envelope::filter(const Box& box, std::span<const Index> champions, std::span<const Index> candidates,
                      std::vector<Index>& out) const {
  const BoxFrame frame(box);
  // Where the box is large beside R nothing is hidden below one body.
  const bool small = box.larger_side() < 2 * patches_.radius();
  const std::size_t begin = out.size();
  Index champion[4] = {none, none, none, none};
  std::copy(champions.begin(), champions.end(), champion);
  const auto is_champion = [&](Index c) {  // without branches, which nothing predicts
    return bool((c == champion[0]) | (c == champion[1]) | (c == champion[2]) | (c == champion[3]));
  };
  bool others = false;
  for (const Index c : candidates) {
    if (!patches_.box(c).meets(box)) continue;
    // A champion is seen at a corner: only a wall can keep it from mattering.
    const bool seen = is_champion(c);
    if ((!seen || patches_[c].has_rim) && !domain_meets(c, frame)) continue;
    others = others || !seen;
    out.push_back(c);
  }
  if (!small || !others) return;

  Cover cover(*this, frame, champions);
  const double size = box.larger_side();
  const auto is_hidden = [&](Index c) {
    if (cover.hides(c, tangent(c, frame.mid, size))) return true;
    for (const Index k : champions) {
      if (hidden_in_line(c, k, frame) || hidden_below_face(c, k, frame)) return true;
    }
    return false;
  };
  std::size_t kept = begin;
  for (std::size_t i = begin; i < out.size(); ++i) {
    const Index c = out[i];
    if (is_champion(c) || !is_hidden(c)) out[kept++] = c;
  }
  out.resize(kept);
}

bool Envelope::stays_hidden(Index c, const Box& box, std::span<const Index> labels, int depth) const {
  const Box& own = patches_.box(c);
  const Box part{{std::max(box.low.x, own.low.x), std::max(box.low.y, own.low.y)},
                 {std::min(box.high.x, own.high.x), std::min(box.high.y, own.high.y)}};
  if (!(part.low.x <= part.high.x && part.low.y <= part.high.y)) return true;
  const BoxFrame frame(part);
  if (!domain_meets(c, frame)) return true;
  Cover cover(*this, frame, labels);
  if (cover.hides(c, tangent(c, frame.mid, part.larger_side()))) return true;
  if (depth == 0) return false;
  Box first = part, second = part;
  if (frame.hx > frame.hy) first.high.x = second.low.x = frame.mid.x;
  else first.high.y = second.low.y = frame.mid.y;
  return stays_hidden(c, first, labels, depth - 1) && stays_hidden(c, second, labels, depth - 1);
}

void Envelope::section(bool vertical, double at, double from, double to, Index start, Index end,
                       std::span<const Index> candidates, std::vector<Crossing>& out) {
  ++counters_.lines;
  out_ = &out;
  stack_.assign(candidates.begin(), candidates.end());
  const std::size_t before = out.size();
  section(Line{vertical, at}, from, start, to, end, 0, 0);
  drop_slivers(Line{vertical, at}, start, before, out);
}

/// Where patches are equally high along a curve, or tangent to each other's borders, rounding alone decides what shows between them.
void Envelope::drop_slivers(const Line& line, Index start, std::size_t first, std::vector<Crossing>& crossings) const {
  std::size_t kept = first;
  const auto label_before = [&](std::size_t i) { return i == first ? start : crossings[i - 1].after; };
  for (std::size_t i = first; i < crossings.size(); ++i) {
    crossings[kept] = crossings[i];
    if (kept > first && crossings[kept].t - crossings[kept - 1].t < tolerance_) {
      --kept;
      const Index before = label_before(kept), after = crossings[kept + 1].after;
      if (before == after) continue;
      crossings[kept].after = after;
      crossings[kept].meeting = meeting(before, after, line.point(crossings[kept].t));
    }
    ++kept;
  }
  crossings.resize(kept);
}

/// stack_[first ..]: the candidates of the stretch around this one.
void Envelope::section(const Line& line, double t0, Index l0, double t1, Index l1, std::size_t first, int depth) {
  const std::size_t begin = stack_.size();
  const std::array<Index, 2> ends{l0, l1};
  std::array<Index, 2> champions;
  int count = 0;
  for (const Index l : ends) {
    if (l != none && (count == 0 || champions[0] != l)) champions[count++] = l;
  }
  const auto has_others = [&](std::size_t from) {
    return std::any_of(stack_.begin() + std::ptrdiff_t(from), stack_.end(), [&](Index c) { return c != l0 && c != l1; });
  };
  bool others = has_others(first);
  if (others) {
    // filter() appends to the vector it reads from.
    kept_.clear();
    filter(line.box(t0, t1), {champions.data(), std::size_t(count)}, {stack_.data() + first, begin - first}, kept_);
    stack_.insert(stack_.end(), kept_.begin(), kept_.end());
    others = has_others(begin);
  } else {
    stack_.insert(stack_.end(), stack_.begin() + std::ptrdiff_t(first), stack_.begin() + std::ptrdiff_t(begin));
  }
  const bool tiny = t1 - t0 <= smallest_stretch_ || depth > 60;
  if (l0 == l1 && (tiny || (!others && l0 != none))) {
    // One label only: its domain may have a notch, but then another label would be left.
    stack_.resize(begin);
    return;
  }
  if (l0 == l1 && l0 == none && stack_.size() == begin) return;
  if (l0 != l1 && (tiny || (!others && single_crossing(line, t0, l0, t1, l1)))) {
    Meeting how = Meeting::rim;
    const double t = tiny ? (t0 + t1) / 2 : locate(line, t0, l0, t1, l1, how);
    if (tiny) how = meeting(l0, l1, line.point(t));
    out_->push_back({t, l1, how});
    stack_.resize(begin);
    return;
  }
  const double tm = t0 + (t1 - t0) / 2;
  const Index lm = winner(line.point(tm), {stack_.data() + begin, stack_.size() - begin});
  section(line, t0, l0, tm, lm, begin, depth + 1);
  section(line, tm, lm, t1, l1, begin, depth + 1);
  stack_.resize(begin);
}

/// True if the domain of the first label, which holds t0, ends before that of the second begins, which holds t1.
bool Envelope::gap(const Line& line, double t0, Index l0, double t1, Index l1) const {
  const auto last_within = [&](double inside, double outside, Index l) {
    for (int i = 0; i < 60 && std::fabs(outside - inside) > tolerance_ / 4; ++i) {
      const double m = inside + (outside - inside) / 2;
      (patches_.contains(l, line.point(m)) ? inside : outside) = m;
    }
    return inside;
  };
  return last_within(t1, t0, l1) - last_within(t0, t1, l0) > 4 * tolerance_;
}

/// True if the two labels, the only ones left, certainly change once. Concave heights have descending derivatives.
bool Envelope::single_crossing(const Line& line, double t0, Index l0, double t1, Index l1) const {
  if (l0 == none || l1 == none) return t1 - t0 < patches_.radius() / 16;
  if (patches_.seam(l0, l1) != nullptr) return true;
  const Point p = line.point(t0), q = line.point(t1);
  const auto slope = [&](Index l, Point at) {
    const Gradient g = patches_.gradient(l, at);
    return line.vertical ? g.y : g.x;
  };
  const bool first_covers = patches_.contains(l0, q), second_covers = patches_.contains(l1, p);
  if (!first_covers || !second_covers) return t1 - t0 < patches_.radius() / 16 && (first_covers || second_covers || !gap(line, t0, l0, t1, l1));
  const Range first{slope(l0, q), slope(l0, p)}, second{slope(l1, q), slope(l1, p)};
  return (second - first).excludes_zero();
}

double Envelope::clamped_height(Index i, Point p) const {
  const double h = patches_.extended_height(i, p);
  return h > below_everything ? h : rim_height(i, p);
}

Gradient Envelope::rim_gradient(Index i) const {
  const Patch& f = patches_[i];
  return f.kind == FeatureKind::edge ? Gradient{f.m * f.gx, f.m * f.gy} : Gradient{0, 0};
}

double Envelope::rim_height(Index i, Point p) const {
  const Patch& f = patches_[i];
  if (f.kind == FeatureKind::vertex) return f.z;
  return f.z + f.m * ((p.x - f.at.x) * f.gx + (p.y - f.at.y) * f.gy);
}

const Bound* Envelope::rim_at(Index i, Point p) const {
  for (const Bound& b : patches_.bounds(i)) {
    if (!b.rim) continue;
    const double value = std::fabs(b.value(p, patches_.square_radius()));
    if (value <= rim_width_ * (b.type == Bound::Type::disc ? 2 * patches_.radius() : 1)) return &b;
  }
  return nullptr;
}

double Envelope::border_height(Index i, Point p) const { return rim_at(i, p) != nullptr ? rim_height(i, p) : clamped_height(i, p); }

Meeting Envelope::meeting(Index a, Index b, Point p) const {
  if (a == none || b == none) return Meeting::rim;
  if (patches_.seam(a, b) != nullptr) return Meeting::seam;
  const bool a_ends = rim_at(a, p) != nullptr, b_ends = rim_at(b, p) != nullptr;
  if (!a_ends && !b_ends) return Meeting::valley;
  const double difference = (a_ends ? rim_height(a, p) : clamped_height(a, p)) - (b_ends ? rim_height(b, p) : clamped_height(b, p));
  const Gradient g = a_ends ? rim_gradient(a) : patches_.gradient(a, p), h = b_ends ? rim_gradient(b) : patches_.gradient(b, p);
  return std::fabs(difference) <= 64 * tolerance_ * (1 + std::hypot(g.x - h.x, g.y - h.y)) ? Meeting::valley : Meeting::rim;
}

/// Where a function with values of different sign at a and b is zero, by the secant.
template <class Function>
double Envelope::root(const Function& value, double a, double fa, double b, double fb) const {
  // Illinois: halving the value of the end that stays so that both ends move.
  double last = (a + b) / 2;
  for (int i = 0, side = 0; i < 80; ++i) {
    double m = a - fa * (b - a) / (fb - fa);
    if (!(m > a)) return a;  // but for rounding it lies between
    if (!(m < b)) return b;
    if (i % 16 == 15) m = a + (b - a) / 2;
    if (std::fabs(m - last) <= smallest_stretch_) break;
    last = m;
    const double fm = value(m);
    if (fm == 0) break;
    if ((fm > 0) == (fa > 0)) {
      a = m;
      fa = fm;
      if (side < 0) fb /= 2;
      side = -1;
    } else {
      b = m;
      fb = fm;
      if (side > 0) fa /= 2;
      side = 1;
    }
  }
  return last;
}

/// The place of the one change from l0 to l1: where the function that they share is zero, or the heights are equal, else by
/// bisection.
double Envelope::locate(const Line& line, double t0, Index l0, double t1, Index l1, Meeting& how) const {
  const Bound* seam = l0 != none && l1 != none ? patches_.seam(l0, l1) : nullptr;
  const bool heights = seam == nullptr && l0 != none && l1 != none;
  const auto value = [&](double t) {  // positive on the side of l0
    const Point p = line.point(t);
    if (seam != nullptr) return (seam->negative ? -1 : 1) * seam->value(p, patches_.square_radius());
    return patches_.extended_height(l0, p) - patches_.extended_height(l1, p);
  };
  const Index two[2] = {l0, l1};
  const std::span<const Index> both(two + (l0 == none), (l0 != none) + (l1 != none));
  double a = t0, b = t1, fa = 0, fb = 0;
  bool smooth = seam != nullptr || heights;
  if (smooth) {
    fa = value(a);
    fb = value(b);
    smooth = std::isfinite(fa) && std::isfinite(fb) && ((fa > 0) != (fb > 0));
  }
  if (smooth) {
    const double t = root(value, a, fa, b, fb);
    const Point p = line.point(t);
    // The domains of both reach as far as where the heights are equal, or one of them ends before.
    if (seam != nullptr || (patches_.contains(l0, p) && patches_.contains(l1, p))) {
      how = seam != nullptr ? Meeting::seam : Meeting::valley;
      return t;
    }
  }
  for (int i = 0; i < 60 && b - a > smallest_stretch_; ++i) {
    const double m = a + (b - a) / 2;
    if (m == a || m == b) break;
    (winner(line.point(m), both) == l0 ? a : b) = m;
  }
  how = meeting(l0, l1, line.point((a + b) / 2));
  return a + (b - a) / 2;
}

GradientRange Envelope::sphere_gradient(Point at, const Box& box, double factor) const {
  const Range dx{box.low.x - at.x, box.high.x - at.x}, dy{box.low.y - at.y, box.high.y - at.y};
  const double near_x = dx.low > 0 ? dx.low : dx.high < 0 ? -dx.high : 0, far_x = std::max(std::fabs(dx.low), std::fabs(dx.high));
  const double near_y = dy.low > 0 ? dy.low : dy.high < 0 ? -dy.high : 0, far_y = std::max(std::fabs(dy.low), std::fabs(dy.high));
  const double square = patches_.square_radius(), least = 1e-12 * square;
  const double most = square - (near_x * near_x + near_y * near_y), fewest = square - (far_x * far_x + far_y * far_y);
  const Range inverse{1 / std::sqrt(std::max(least, most)), 1 / std::sqrt(std::max(least, fewest))};
  const Range f{-factor, -factor};
  return {dx * inverse * f, dy * inverse * f};
}

GradientRange Envelope::gradient_range(Index i, const Box& box) const {
  const Patch& f = patches_[i];
  if (f.kind == FeatureKind::face) return {{f.gx, f.gx}, {f.gy, f.gy}};
  if (f.kind == FeatureKind::vertex) return sphere_gradient(f.at, box, 1);
  const Point mid = box.middle();
  const double aside = (mid.y - f.at.y) * f.gx - (mid.x - f.at.x) * f.gy;
  const double spread = std::fabs(f.gx) * box.half_y() + std::fabs(f.gy) * box.half_x();
  const double square = patches_.square_radius(), least = 1e-12 * square;
  const auto across = [&](double beta) { return -f.q * beta / std::sqrt(std::max(least, square - beta * beta)); };
  const Range a{across(aside + spread), across(aside - spread)};
  const Range along{f.m * f.gx, f.m * f.gx}, along_y{f.m * f.gy, f.m * f.gy};
  return {along + a * Range{-f.gy, -f.gy}, along_y + a * Range{f.gx, f.gx}};
}

Range Envelope::derivative_range(Index i, const Box& box, Gradient d) const {
  const Patch& f = patches_[i];
  if (f.kind != FeatureKind::edge) {
    const GradientRange g = gradient_range(i, box);
    return g.x * Range{d.x, d.x} + g.y * Range{d.y, d.y};
  }
  const Point mid = box.middle();
  const double aside = (mid.y - f.at.y) * f.gx - (mid.x - f.at.x) * f.gy;
  const double spread = std::fabs(f.gx) * box.half_y() + std::fabs(f.gy) * box.half_x();
  const double square = patches_.square_radius(), least = 1e-12 * square;
  const auto across = [&](double beta) { return -f.q * beta / std::sqrt(std::max(least, square - beta * beta)); };
  const double along = f.m * (f.gx * d.x + f.gy * d.y), aslant = d.y * f.gx - d.x * f.gy;
  return Range{across(aside + spread), across(aside - spread)} * Range{aslant, aslant} + Range{along, along};
}

Gradient Envelope::bound_gradient(const Bound& b, Point p) const {
  const double dx = p.x - b.at.x, dy = p.y - b.at.y;
  if (b.type == Bound::Type::line) return {b.nx, b.ny};
  if (b.type == Bound::Type::disc) return {2 * dx, 2 * dy};
  const double square = patches_.square_radius();
  const double up = std::sqrt(std::max(1e-12 * square, square - (dx * dx + dy * dy)));
  return {b.nx - b.c * dx / up, b.ny - b.c * dy / up};
}

GradientRange Envelope::bound_gradient_range(const Bound& b, const Box& box) const {
  if (b.type == Bound::Type::line) return {{b.nx, b.nx}, {b.ny, b.ny}};
  if (b.type == Bound::Type::disc) {
    return {{2 * (box.low.x - b.at.x), 2 * (box.high.x - b.at.x)}, {2 * (box.low.y - b.at.y), 2 * (box.high.y - b.at.y)}};
  }
  const GradientRange s = sphere_gradient(b.at, box, b.c);
  return {s.x + Range{b.nx, b.nx}, s.y + Range{b.ny, b.ny}};
}

}  // namespace krepl::terrain
