#include <algorithm>

#include "terrain/box_frame.hpp"

// Which patches cannot show in a box: outside of their domains, or hidden below the bodies of others.
namespace krepl::terrain {

using FeatureKind = Terrain::FeatureKind;

template <class Real>
RangeOf<Real> Envelope<Real>::bound_range(const Bound& b, const Box& box) const {
  const BoxFrame frame(box);
  return {extreme<1>(b, frame), -extreme<-1>(b, frame)};
}

/// Of a patch whose bounding rectangle meets the box. However little of it reaches into the box: beside a wall that may
/// be much taller than it is wide.
template <class Real>
inline bool Envelope<Real>::domain_meets(Index i, const BoxFrame& box) const {
  const Patch& f = patches_[i];
  for (const Bound& b : patches_.bounds(i)) {
    if (b.negative ? extreme<1>(b, box) >= 0 : extreme<-1>(b, box) > 0) return false;
    if (is_fine<Real> && b.type == BoundType::cone && lies_beyond(b, box)) return false;
  }
  return f.kind != FeatureKind::edge || !f.has_rim || axis_meets(i, box);
}

/// True if all of a small box lies beyond a cone, by tangent planes: they tell more than bounds of each term where
/// these nearly cancel out.
template <class Real>
bool Envelope<Real>::lies_beyond(const Bound& b, const BoxFrame& f) const {
  const Real square = patches_.square_radius();
  const Real far_x = absolute(f.mid.x - b.at.x) + f.hx, far_y = absolute(f.mid.y - b.at.y) + f.hy;
  if (!(far_x * far_x + far_y * far_y < square)) return false;
  const Real sign = b.negative ? 1 : -1;  // to be shown: sign * value > 0
  const auto is_beyond = [&](Real value) { return sign * value > noise_; };
  if (sign * b.c >= 0) {  // concave
    for (const Point p : f.box.corners()) {
      if (!is_beyond(b.value(p, square))) return false;
    }
    return true;
  }
  const Gradient g = bound_gradient(b, f.mid);
  return is_beyond(b.value(f.mid, square) - sign * (absolute(g.x) * f.hx + absolute(g.y) * f.hy));
}

/// True if the axis of an edge has places that a ball in the box may touch: the same for its ends.
///
/// Where a sphere goes on beyond an end, the seam is tangent to the wall, and what is closer above the wall than is
/// told apart may as well be the sphere's. Where none does, the next edge may be in nearly the same line, and what is
/// left out would be missing.
template <class Real>
bool Envelope<Real>::axis_meets(Index i, const BoxFrame& box) const {
  const Patch& f = patches_[i];
  const Real dx = box.mid.x - f.at.x, dy = box.mid.y - f.at.y;
  const Real along = dx * f.gx + dy * f.gy, aside = absolute(dy * f.gx - dx * f.gy);
  const Real along_spread = absolute(f.gx) * box.hx + absolute(f.gy) * box.hy + noise_;
  const Real aside_spread = absolute(f.gy) * box.hx + absolute(f.gx) * box.hy;
  const auto up = [&](Real b) { return square_root(std::max(Real(0), patches_.square_radius() - b * b)); };
  const Real low_up = up(aside + aside_spread), high_up = up(std::max(Real(0), aside - aside_spread));
  const Real least_told = square_root(2 * patches_.radius() * smallest_stretch_);  // what lines across the wall still tell
  const auto least = [&](BoundSource end) {
    for (const Bound& b : patches_.bounds(i)) {
      if (b.source == end && b.partner != none && patches_[b.partner].kind == FeatureKind::vertex) return least_up_;
    }
    return is_fine<Real> ? least_told : Real(0);
  };
  const Real shift = f.m * f.flat, at_start = least(BoundSource::start), at_end = least(BoundSource::end);
  return along + along_spread + shift * std::max(at_start, shift > 0 ? high_up : low_up) >= 0 &&
         along - along_spread + shift * std::max(at_end, shift > 0 ? low_up : high_up) <= f.length;
}

template <class Real>
bool Envelope<Real>::domain_meets(Index i, const Box& box) const {
  return patches_.box(i).meets(box) && domain_meets(i, BoxFrame(box));
}

template <class Real>
bool Envelope<Real>::covers(const Bound& b, const Box& box) const {
  return is_within(b, BoxFrame(box));
}

/// Where a tangent plane bounds the patch well over a box: in its middle, but not closer to the rim than the box is
/// wide, unless all of the box is. Beside the rim heights fall like square roots, and what matters is how far inside
/// the box reaches across it.
template <class Real>
inline PointOf<Real> Envelope<Real>::support_point(Index i, const BoxFrame& box) const {
  const Patch& f = patches_[i];
  const Point mid = box.mid;
  if (f.kind == FeatureKind::face) return mid;
  const Real radius = patches_.radius(), size = std::min(2 * std::max(box.hx, box.hy), radius / 2);
  const Real dx = mid.x - f.at.x, dy = mid.y - f.at.y;
  if (f.kind == FeatureKind::vertex) {
    const Real square = dx * dx + dy * dy, most = radius - size;
    if (square <= most * most) return mid;
    const Real s = most / square_root(square);
    return {f.at.x + s * dx, f.at.y + s * dy};
  }
  const Real aside = dy * f.gx - dx * f.gy, distance = absolute(aside);
  if (distance <= radius - size) return mid;
  const Real spread = absolute(f.gx) * box.hy + absolute(f.gy) * box.hx;
  const Real inside = radius - distance + spread;
  const Real at = radius - std::max(least_square * radius, std::min({size, 2 * spread, inside}));
  if (distance <= at) return mid;
  const Real shift = (aside > 0 ? at : -at) - aside;
  return {mid.x - shift * f.gy, mid.y + shift * f.gx};
}

template <class Real>
typename Envelope<Real>::Plane Envelope<Real>::plane_of(const Patch& face, Point p) const {
  return {face.z + (face.gx * (p.x - face.at.x) + face.gy * (p.y - face.at.y)), {face.gx, face.gy}};
}

/// True if a face's plane says little about its height within a large box.
template <class Real>
bool Envelope<Real>::is_steep(const Patch& f) const {
  return f.kind == FeatureKind::face && absolute(f.gx) + absolute(f.gy) >= steep;
}

/// A linear function that is nowhere in the part of the box in the patch's domain below the patch.
template <class Real>
inline typename Envelope<Real>::Plane Envelope<Real>::support(Index i, const BoxFrame& box) const {
  const Patch& f = patches_[i];
  const Point mid = box.mid;
  if (f.kind != FeatureKind::face) {
    const Point p = support_point(i, box);
    const Gradient g = patches_.gradient(i, p);
    return {patches_.extended_height(i, p) + g.x * (mid.x - p.x) + g.y * (mid.y - p.y), g};
  }
  const Plane whole = plane_of(f, mid);
  return is_steep(f) ? support_of_steep(i, whole, box) : whole;
}

/// A steep face that rises towards one of its own sides is not above its height there.
template <class Real>
typename Envelope<Real>::Plane Envelope<Real>::support_of_steep(Index i, const Plane& whole,
                                                                const BoxFrame& box) const {
  const Patch& f = patches_[i];
  const auto highest = [&](const Plane& t) {
    return t.height + absolute(t.gradient.x) * box.hx + absolute(t.gradient.y) * box.hy;
  };
  Plane best = whole;
  for (const Bound& b : patches_.bounds(i)) {
    const Real sign = b.sign(), rise = sign * (f.gx * b.nx + f.gy * b.ny);
    if (!(rise > 0)) continue;
    const Real k = sign * rise;
    const Plane t{whole.height - k * b.value(box.mid, 0), {f.gx - k * b.nx, f.gy - k * b.ny}};
    if (highest(t) < highest(best)) best = t;
  }
  return best;
}

template <class Real>
bool Envelope<Real>::domain_covers(Index i, const BoxFrame& box) const {
  for (const Bound& b : patches_.bounds(i)) {
    if (!is_within(b, box)) return false;
  }
  return true;
}

/// The bodies of a few labels over a box, evaluated at its corners as far as needed: a concave height is least at a
/// corner, less a plane too.
template <class Real>
class Envelope<Real>::Cover {
 public:
  Cover(const Envelope& envelope, const BoxFrame& frame, std::span<const Index> labels)
      : envelope_(envelope), frame_(frame), bodies_(labels.size()), corner_(frame.box.corners()) {
    const Box& box = frame.box;
    if (box.low.x == box.high.x || box.low.y == box.high.y) step_ = 2;
    for (std::size_t k = 0; k < bodies_; ++k) body_[k].label = labels[k];
  }

  /// True if the patch is nowhere seen.
  bool hides(Index c) {
    if (hides(c, envelope_.support(c, frame_))) return true;
    const Patch& f = envelope_.patches_[c];
    return envelope_.is_steep(f) && hides(c, envelope_.plane_of(f, frame_.mid));
  }

  /// The same of a cylinder or sphere, which beside a wall no tangent plane bounds well: all of its patch lies on one side of
  /// the plane through each vertex orthogonal to the edge. So does what of a sphere is outside of a higher ball: below the plane
  /// of their common circle, which may be that in which a third patch meets both.
  bool hides_within_planes(Index c) {
    const Patch& f = envelope_.patches_[c];
    if (f.kind == FeatureKind::face) return false;
    for (const Bound& b : envelope_.patches_.bounds(c)) {
      if (b.type != BoundType::cone || !(b.sign() * b.c > 0)) continue;
      const Real z = f.kind == FeatureKind::edge ? envelope_.axis_height(c, b.at) : f.z;
      if (hides_below(c, b.at, z, {-b.nx / b.c, -b.ny / b.c})) return true;
    }
    for (std::size_t k = 0; k < bodies_; ++k) {
      const Patch& body = envelope_.patches_[body_[k].label];
      if (body.kind != f.kind) continue;
      if (f.kind == FeatureKind::edge) {
        if (hides_beside_crossing(c, body_[k].label)) return true;
        continue;
      }
      const Real x = body.at.x - f.at.x, y = body.at.y - f.at.y, up = body.z - f.z;
      if (up > 0 && hides_below(c, {f.at.x + x / 2, f.at.y + y / 2}, f.z + up / 2, {-x / up, -y / up})) return true;
    }
    return false;
  }

 private:
  /// The same, where the axes of two cylinders cross.
  bool hides_beside_crossing(Index c, Index other) {
    HalfSpace part[2];
    const std::size_t count = envelope_.outside_of_crossing(c, other, frame_, part);
    return std::any_of(part, part + count, [&](const HalfSpace& h) {
      if (envelope_.most_beyond(c, h, frame_) < -envelope_.noise_) return true;
      return h.normal.z < -least_normal && hides_below(c, h.at, h.z, {-h.normal.x / h.normal.z, -h.normal.y / h.normal.z});
    });
  }

  /// True if what of an edge's patch is outside of another label's cylinder lies beyond an upright plane, on the inner side of a
  /// wall: where R is a whole number of cells walls run along such valleys.
  bool is_cut_off(Index c, const Bound& wall) const {
    if (!is_fine<Real> || wall.type != BoundType::line || envelope_.patches_[c].kind != FeatureKind::edge) return false;
    for (std::size_t k = 0; k < bodies_; ++k) {
      HalfSpace part[2];
      const std::size_t count = envelope_.outside_of_crossing(c, body_[k].label, frame_, part);
      for (std::size_t i = 0; i < count; ++i) {
        const HalfSpace& h = part[i];
        const Real length = norm(h.normal.x, h.normal.y);
        if (!(absolute(h.normal.z) <= Precision<Real>::corner && length > least_normal)) continue;
        const auto is_inside = [&](Point p) {
          const Real beyond = (h.normal.x * (p.x - h.at.x) + h.normal.y * (p.y - h.at.y)) / length;
          return envelope_.outside(wall, p) + beyond <= envelope_.tolerance_ / 4;
        };
        if (std::all_of(corner_.begin(), corner_.end(), is_inside)) return true;
      }
    }
    return false;
  }

  bool hides_below(Index c, Point at, Real z, Gradient slope) {
    return hides(c, Plane{z + slope.x * (frame_.mid.x - at.x) + slope.y * (frame_.mid.y - at.y), slope});
  }

  /// The same, if it lies below the given plane.
  bool hides(Index c, const Plane& plane) {
    hidden_ = c;
    noise_ = envelope_.noise_ * (1 + absolute(plane.gradient.x) + absolute(plane.gradient.y));
    const std::array<Real, 4> t = plane.at_corners(frame_);
    const Real hx = plane.gradient.x * frame_.hx, hy = plane.gradient.y * frame_.hy;
    const int highest = step_ == 2 ? (hx + hy > 0 ? 2 : 0) : hy > 0 ? (hx > 0 ? 2 : 3) : (hx > 0 ? 1 : 0);
    if (hides(c, t, highest)) return true;
    // Faces that are nearly vertical have a top, but no tangent plane worth having.
    const Real top = envelope_.patches_[c].top;
    if (!(top < t[highest])) return false;
    const std::array<Real, 4> level{top, top, top, top};
    return below_one(c, masks(level, highest));
  }

  static constexpr std::size_t most = 4;
  static constexpr double least_normal = 0x1p-20;  // of unit vectors' sums
  using Masks = std::array<unsigned, most>;  // per body: at which corners it is higher
  struct Body {
    Index label;
    std::optional<Wall> wall;  // where the body ends within the box
    Real height[4];            // with a wall: of its rim
    unsigned known = 0;
    bool ends = false;
    enum class Covers : std::uint8_t { unknown, no, yes } covers = Covers::unknown;
  };

  unsigned all_corners() const { return step_ == 1 ? 15 : 5; }

  bool is_above(Body& b, int i, Real t) {
    if ((b.known >> i & 1) == 0) {
      b.height[i] = envelope_.patches_.body_height(b.label, corner_[i]);
      b.known |= 1u << i;
      if (!(b.height[i] > below_everything)) end_at_wall(b);
    }
    if (b.height[i] - noise_ > t) return true;
    if (b.ends || !(b.height[i] + noise_ > t)) return false;
    // A patch over all of the box may hide what sticks out by less than matters. One that is not might be hidden
    // itself, as part of another's body, by what it would hide: then only what is clearly lower.
    if (b.covers == Body::Covers::unknown) {
      b.covers = envelope_.domain_covers(b.label, frame_) ? Body::Covers::yes : Body::Covers::no;
    }
    return b.covers == Body::Covers::yes && !envelope_.shows_first(hidden_, b.label, frame_);
  }

  void end_at_wall(Body& b) {
    b.wall = envelope_.wall_through(b.label, frame_);
    b.ends = true;
    b.known = 15;
    for (int i = 0; i < 4; ++i)
      b.height[i] = b.wall ? envelope_.rim_height(b.label, corner_[i]) - b.wall->lowered : below_everything;
  }

  /// Without any bit if no body is higher at some corner.
  Masks masks(const std::array<Real, 4>& t, int first) {
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

  /// The same of a body that ends in the box in a straight wall, on the inner side of that: where a plane is as high as the wall all
  /// along it, the body rises faster.
  bool is_above_inside(const Body& b, const std::array<Real, 4>& t) const {
    if (b.wall->outline.type != BoundType::line) return false;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t j = (i + 1) % 4;
      const Real here = envelope_.outside(b.wall->outline, corner_[i]), next = envelope_.outside(b.wall->outline, corner_[j]);
      if (here < 0 && !(envelope_.patches_.body_height(b.label, corner_[i]) - noise_ > t[i])) return false;
      if ((here < 0) == (next < 0)) continue;
      const Real u = here / (here - next);
      const Point p{corner_[i].x + u * (corner_[j].x - corner_[i].x), corner_[i].y + u * (corner_[j].y - corner_[i].y)};
      if (!(envelope_.rim_height(b.label, p) - b.wall->lowered + noise_ > t[i] + u * (t[j] - t[i]))) return false;
    }
    return true;
  }

  bool below_one(Index c, const Masks& m) const {
    for (std::size_t k = 0; k < bodies_; ++k) {
      if (m[k] != all_corners()) continue;
      if (!body_[k].wall) return true;
      const Bound& wall = body_[k].wall->outline;
      if (envelope_.ends_before(c, wall, frame_.box) || is_cut_off(c, wall)) return true;
    }
    return false;
  }

  bool hides(Index c, const std::array<Real, 4>& t, int highest) {
    const Masks m = masks(t, highest);
    if (below_one(c, m)) return true;
    for (std::size_t k = 0; k < bodies_; ++k) {
      for (std::size_t l = k + 1; l < bodies_; ++l) {
        if ((m[k] | m[l]) != all_corners()) continue;
        const Body &a = body_[k], &b = body_[l];
        if (!a.ends && !b.ends && below_mean(a, b, t)) return true;
        // Two walls back to back: one of the bodies is there at every place that matters.
        if (a.wall && b.wall && envelope_.back_to_back(a.wall->outline, b.wall->outline, frame_.box, 0) &&
            (m[k] == all_corners() || is_above_inside(a, t)) && (m[l] == all_corners() || is_above_inside(b, t))) {
          return true;
        }
      }
    }
    return false;
  }

  /// Below a weighted mean of two bodies, which is concave too and not above the higher one.
  bool below_mean(const Body& a, const Body& b, const std::array<Real, 4>& t) const {
    Real low = 0, high = 1;
    for (int i = 0; i < 4; i += step_) {
      const Real slope = a.height[i] - b.height[i], need = t[i] + noise_ - b.height[i];
      if (slope > 0)
        low = std::max(low, need / slope);
      else if (slope < 0)
        high = std::min(high, need / slope);
      else if (need >= 0)
        return false;
    }
    return low < high;
  }

  const Envelope& envelope_;
  const BoxFrame& frame_;
  Index hidden_ = none;  // what is asked for
  Real noise_ = 0;  // of heights on a slope like that of what is to be hidden
  std::size_t bodies_;
  int step_ = 1;  // a line has two ends
  std::array<Point, 4> corner_;
  Body body_[most];
};

template <class Real>
std::size_t Envelope<Real>::filter(const Box& box, std::span<const Index> champions, std::span<const Index> candidates,
                                   std::vector<Index>& out, bool also_hidden) const {
  const BoxFrame frame(box);
  // Where the box is large beside R nothing is hidden below one body.
  const bool small = box.larger_side() < 2 * patches_.radius();
  const std::size_t begin = out.size();
  Index champion[4] = {none, none, none, none};
  std::copy(champions.begin(), champions.end(), champion);
  const auto is_champion = [&](Index c) {  // without branches, which nothing predicts
    return bool((c == champion[0]) | (c == champion[1]) | (c == champion[2]) | (c == champion[3]));
  };
  // Those whose bounding rectangle meets the box: also without branches.
  out.resize(begin + candidates.size());
  std::size_t end = begin;
  for (const Index c : candidates) {
    out[end] = c;
    end += std::size_t(patches_.box(c).meets(box));
  }
  bool others = false;
  std::size_t met = begin;
  for (std::size_t i = begin; i < end; ++i) {
    const Index c = out[i];
    // A champion is seen at a corner: only a wall can keep it from mattering. All of a domain meets the box anyway.
    const bool seen = is_champion(c);
    if ((!seen || patches_[c].has_rim) && !box.contains(patches_.box(c)) && !domain_meets(c, frame)) continue;
    others = others || !seen;
    out[met++] = c;
  }
  out.resize(met);
  if ((!small && !far_) || !others || !also_hidden) return 0;

  // Of features that lie beside each other as in grids little else is left in large boxes.
  const bool by_feature =
      box.larger_side() < (patches_.are_of_graph() ? patches_.radius() / 64 : 2 * patches_.radius());
  Cover cover(*this, frame, champions);
  const auto is_hidden = [&](Index c) {
    if (small && cover.hides(c)) return true;
    if (far_ && hidden_by_balls(c, champions, box)) return true;
    return by_feature && hidden_by_feature(c, champions, frame);
  };
  std::size_t kept = begin;
  for (std::size_t i = begin; i < out.size(); ++i) {
    const Index c = out[i];
    if (is_champion(c) || !is_hidden(c)) out[kept++] = c;
  }
  const std::size_t hidden = out.size() - kept;
  out.resize(kept);
  return hidden;
}

template <class Real>
bool Envelope<Real>::stays_hidden(Index c, const Box& box, std::span<const Index> labels, int depth) const {
  const Box part = box.intersection(patches_.box(c));
  if (part.is_empty()) return true;
  const BoxFrame frame(part);
  if (!domain_meets(c, frame)) return true;
  Cover cover(*this, frame, labels);
  if (cover.hides(c) || cover.hides_within_planes(c)) return true;
  if ((far_ || is_fine<Real>) && hidden_by_balls(c, labels, part)) return true;
  if (is_fine<Real> && hidden_by_feature(c, labels, frame)) return true;
  if (depth == 0) return false;
  Box first = part, second = part;
  if (frame.hx > frame.hy)
    first.high.x = second.low.x = frame.mid.x;
  else
    first.high.y = second.low.y = frame.mid.y;
  return stays_hidden(c, first, labels, depth - 1) && stays_hidden(c, second, labels, depth - 1);
}

/// True if a sphere's patch lies beyond its seam to an edge, but for what is nearer to the wall than `least_up` above it: there
/// the seam is tangent to the wall.
template <class Real>
bool Envelope<Real>::lies_beyond_seam(Index sphere, Index edge, const BoxFrame& frame, Real least_up) const {
  if (patches_[sphere].kind != FeatureKind::vertex) return false;
  for (const Bound& b : patches_.bounds(sphere)) {
    if (b.partner != edge || b.type != BoundType::cone) continue;
    if (b.negative ? extreme<1>(b, frame, least_up) >= 0 : extreme<-1>(b, frame, least_up) > 0) return true;
  }
  return false;
}

/// Bodies are concave, and so are weighted means of two of them: least against a plane at the corners of the box. What
/// is hardly above the rims of two walls back to back is below the bodies soon inside of them, which rise there like
/// square roots.
template <class Real>
bool Envelope<Real>::hidden_within_tolerance(Index i, std::span<const Index> uppers, const Box& box) const {
  constexpr std::size_t most = 6;
  if (box.larger_side() >= 2 * patches_.radius()) return false;
  const BoxFrame frame(box);
  const std::array<Point, 4> corner = box.corners();
  const std::array<Real, 4> t = support(i, frame).at_corners(frame);
  std::array<std::array<Real, 4>, most> above;  // of the bodies over the plane
  std::array<Bound, most> wall;
  std::array<Real, most> inset;
  std::size_t count = 0, walls = 0;
  const Real rim_up = square_root(patches_.radius() *
                                  rim_width_);  // above the foot of a wall, where both precisions leave out what shows
  for (std::size_t u = 0; u < uppers.size() && count < most && walls < most; ++u) {
    if (shows_first(i, uppers[u], frame) && are_coplanar(i, uppers[u], box)) continue;
    if (hidden_beside(i, uppers[u], frame, rim_up) || (is_fine<Real> && lies_beyond_seam(i, uppers[u], frame, rim_up)))
      return true;
    bool reaches = true;
    for (int k = 0; k < 4 && reaches; ++k) {
      const Real body = patches_.body_height(uppers[u], corner[k]);
      reaches = body > below_everything;
      above[count][k] = body - t[k] + tolerance_;
    }
    if (reaches) {
      ++count;
      continue;
    }
    const std::optional<Wall> end = wall_through(uppers[u], frame);
    if (!end) continue;
    inset[walls] = inset_of(uppers[u], *end, box, t);
    if (!is_finite(inset[walls])) continue;
    if (lies_inside(i, end->outline, inset[walls], box)) return true;
    if (hidden_beyond(i, *end, inset[walls], uppers, frame)) return true;
    if (beside_beyond(i, end->outline, inset[walls], uppers, box)) return true;
    for (std::size_t w = 0; w < walls; ++w) {
      if (back_to_back(wall[w], end->outline, box, inset[w] + inset[walls])) return true;
    }
    wall[walls++] = end->outline;
  }
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = 0; b <= a; ++b) {
      Real low = 0, high = 1;  // weights of a that are enough
      for (int k = 0; k < 4; ++k) {
        const Real slope = above[a][k] - above[b][k];
        if (slope > 0)
          low = std::max(low, -above[b][k] / slope);
        else if (slope < 0)
          high = std::min(high, -above[b][k] / slope);
        else if (above[b][k] < 0)
          high = -1;
      }
      if (low <= high) return true;
    }
  }
  return false;
}

template class Envelope<double>;
template class Envelope<DoubleDouble>;

}  // namespace krepl::terrain
