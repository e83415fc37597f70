#include "section/nesting.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/box_tree.hpp"
#include "kernel/vectors.hpp"

namespace krepl::section {

using namespace vectors;

namespace {

double cross_xy(Point3 a, Point3 b) { return a.x * b.y - a.y * b.x; }

/// s of the places at which a piece runs along one of the axes of the plane, ascending; with 0 and 1.
std::vector<double> turns(const CutPiece& piece, bool in_x) {
  std::vector<double> result{0};
  if (piece.kind != CutPiece::Kind::line && piece.from != piece.to) {
    const double first =
        in_x ? std::atan2(piece.axis[1].x, piece.axis[0].x) : std::atan2(piece.axis[1].y, piece.axis[0].y);
    const double low = std::min(piece.from, piece.to), high = std::max(piece.from, piece.to);
    for (double k = std::ceil((low - first) / std::numbers::pi); first + k * std::numbers::pi < high; ++k) {
      const double s = (first + k * std::numbers::pi - piece.from) / (piece.to - piece.from);
      if (s > 0 && s < 1) result.push_back(s);
    }
    std::sort(result.begin(), result.end());
  }
  result.push_back(1);
  return result;
}

kernel::Box box_of(const CutPiece& piece) {
  kernel::Box box;
  for (const bool in_x : {false, true}) {
    for (const double s : turns(piece, in_x)) {
      const Point3 p = piece.at(s);
      box.add(Point{p.x, p.y});
    }
  }
  return box;
}

/// How often the ray from p towards smaller x meets the piece, odd or even.
bool crosses(const CutPiece& piece, Point p) {
  bool odd = false;
  const std::vector<double> parts = turns(piece, false);
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    double a = parts[i], b = parts[i + 1];
    const bool above = piece.at(a).y > p.y;
    if (above == (piece.at(b).y > p.y)) continue;
    for (int k = 0; k < 60; ++k) {
      const double m = a + (b - a) / 2;
      const Point3 at_a = piece.at(a), at_b = piece.at(b);
      if (std::max(at_a.x, at_b.x) < p.x && piece.kind == CutPiece::Kind::line) break;
      (piece.at(m).y > p.y) == above ? a = m : b = m;
    }
    odd ^= piece.at(a).x < p.x;
  }
  return odd;
}

}  // namespace

double ring_area(std::span<const CutPiece> ring) {
  const Point3 base = ring[0].start;
  double area = 0;
  for (const CutPiece& piece : ring) {
    area += cross_xy(piece.start - base, piece.end - base);
    if (piece.kind == CutPiece::Kind::line) continue;
    const double t = piece.to - piece.from;
    const double excess = std::abs(t) < 1e-3 ? t * t * t / 6 : t - std::sin(t);
    area += excess * cross_xy(piece.axis[0], piece.axis[1]);
  }
  return area / 2;
}

void nest(Contour& contour) {
  const std::size_t rings = contour.ring_begin.size() - 1;
  std::vector<double> area(rings);
  std::vector<Contour::Index> ring_of(contour.pieces.size());
  std::vector<kernel::Box> boxes;
  contour.ring_is_hole.assign(rings, false);
  contour.ring_parent.assign(rings, Contour::none);
  for (std::size_t r = 0; r < rings; ++r) {
    area[r] =
        ring_area({contour.pieces.data() + contour.ring_begin[r], contour.ring_begin[r + 1] - contour.ring_begin[r]});
    contour.ring_is_hole[r] = area[r] < 0;
    std::fill(ring_of.begin() + contour.ring_begin[r], ring_of.begin() + contour.ring_begin[r + 1], Contour::Index(r));
  }
  for (const CutPiece& piece : contour.pieces) boxes.push_back(box_of(piece));
  const std::vector<kernel::Box> box = boxes;
  const kernel::BoxTree tree(std::move(boxes));
  std::vector<Contour::Index> around;
  for (std::size_t r = 0; r < rings; ++r) {
    const auto ring = contour.ring(r);
    const auto longest = std::max_element(ring.begin(), ring.end(), [](const CutPiece& a, const CutPiece& b) {
      return distance(a.start, a.at(0.5)) < distance(b.start, b.at(0.5));
    });
    const Point3 middle = longest->at(0.5);
    const Point p{middle.x, middle.y};
    around.clear();
    const auto limit = [] { return -std::numeric_limits<double>::infinity(); };
    tree.visit_left_of(p, limit, [&](std::size_t i) {
      if (ring_of[i] != r && crosses(contour.pieces[i], p)) around.push_back(ring_of[i]);
    });
    std::sort(around.begin(), around.end());
    for (std::size_t i = 0; i < around.size();) {
      const auto last = std::upper_bound(around.begin(), around.end(), around[i]) - around.begin();
      const Contour::Index other = around[i], parent = contour.ring_parent[r];
      if ((std::size_t(last) - i) % 2 == 1 && contour.ring_is_hole[other] != contour.ring_is_hole[r] &&
          (parent == Contour::none || std::abs(area[other]) < std::abs(area[parent])))
        contour.ring_parent[r] = other;
      i = std::size_t(last);
    }
  }
}

}  // namespace krepl::section
