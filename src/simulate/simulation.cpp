#include "krepl/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "kernel/parallel.hpp"
#include "simulate/part_heights.hpp"
#include "simulate/path_pieces.hpp"
#include "simulate/swept_tool.hpp"

namespace krepl {
namespace {

using simulate::Dexels;
using simulate::Piece;
using simulate::SweptTool;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t tile_side = 32;
constexpr double arc_error_of_cell = 1e-3;
constexpr double rounding_of_scale = 1e-11;

Status check_path(const ToolPath& path) {
  const auto finite = [](Point3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); };
  if (!finite(path.start)) return Error{ErrorCode::input, "the path's start is not finite", "", ""};
  for (std::size_t i = 0; i < path.moves.size(); ++i) {
    const Move& move = path.moves[i];
    const bool arc = move.kind == MoveKind::clockwise || move.kind == MoveKind::counter_clockwise;
    if (!finite(move.end) || (arc && !finite(move.centre)))
      return Error{ErrorCode::input, "a coordinate is not finite", "move " + std::to_string(i), "correct the path"};
  }
  return std::monostate{};
}

Status check_stock(const StockOptions& stock, const Terrain& part) {
  if (!std::isfinite(stock.cell) || !(stock.cell > 0))
    return Error{ErrorCode::usage, "the distance of dexels is not a finite number greater than zero", "",
                 "change the cell"};
  if (!std::isfinite(stock.margin) || !(stock.margin >= 0))
    return Error{ErrorCode::usage, "the stock's margin is not a finite number, zero or more", "", "change the margin"};
  if (std::isinf(stock.top) || stock.top < part.lowest().z + part.origin().z)
    return Error{ErrorCode::usage, "the stock's top is below the part", "", "give a height in the part's coordinates"};
  const double columns = (part.highest().x - part.lowest().x + 2 * stock.margin) / stock.cell + 1;
  const double rows = (part.highest().y - part.lowest().y + 2 * stock.margin) / stock.cell + 1;
  if (!(columns * rows < 0x1p31))
    return Error{ErrorCode::usage, "there are too many dexels", "", "give a larger cell or a smaller margin"};
  return std::monostate{};
}

/// Pieces by the tiles they come near, in their order.
struct TileLists {
  std::vector<std::size_t> begin;
  std::vector<std::uint32_t> piece;
};

/// Columns and rows of dexels within reach of a piece, first and last.
struct Reach {
  std::size_t c0, c1, r0, r1;
};

bool reach_of(const Piece& piece, double radius, const Dexels& dexels, Reach& reach) {
  const auto range = [&](double a, double b, double first, std::size_t count, std::size_t& from, std::size_t& to) {
    const double low = std::floor((std::min(a, b) - radius - first) / dexels.cell);
    const double high = std::ceil((std::max(a, b) + radius - first) / dexels.cell);
    if (!(high >= 0 && low <= double(count - 1))) return false;
    from = std::size_t(std::max(low, 0.0)), to = std::size_t(std::min(high, double(count - 1)));
    return true;
  };
  return range(piece.from.x, piece.to.x, dexels.first.x, dexels.columns, reach.c0, reach.c1) &&
         range(piece.from.y, piece.to.y, dexels.first.y, dexels.rows, reach.r0, reach.r1);
}

TileLists by_tile(const std::vector<Piece>& pieces, double radius, const Dexels& dexels) {
  const std::size_t across = (dexels.columns + tile_side - 1) / tile_side,
                    up = (dexels.rows + tile_side - 1) / tile_side;
  const auto for_each = [&](const auto& visit) {
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      Reach reach;
      if (!reach_of(pieces[i], radius, dexels, reach)) continue;
      for (std::size_t r = reach.r0 / tile_side; r <= reach.r1 / tile_side; ++r)
        for (std::size_t c = reach.c0 / tile_side; c <= reach.c1 / tile_side; ++c) visit(i, r * across + c);
    }
  };
  TileLists lists;
  lists.begin.assign(across * up + 1, 0);
  for_each([&](std::size_t, std::size_t tile) { ++lists.begin[tile + 1]; });
  for (std::size_t t = 0; t < across * up; ++t) lists.begin[t + 1] += lists.begin[t];
  lists.piece.resize(lists.begin.back());
  std::vector<std::size_t> next(lists.begin.begin(), lists.begin.end() - 1);
  for_each([&](std::size_t i, std::size_t tile) { lists.piece[next[tile]++] = std::uint32_t(i); });
  return lists;
}

}  // namespace

/// The material of one tile under all pieces in turn.
class Simulation::Work {
 public:
  struct Found {
    Extreme gouge, rapid_cut;
    std::vector<std::uint32_t> rapids;  // that cut, ascending
  };
  Work(Simulation& s, const Dexels& dexels, const std::vector<Piece>& pieces, const SweptTool& tool)
      : s_(s), dexels_(dexels), pieces_(pieces), tool_(tool) {}

  Found run(std::size_t tile, const std::uint32_t* first, const std::uint32_t* last) const {
    const std::size_t across = (dexels_.columns + tile_side - 1) / tile_side;
    const std::size_t c0 = tile % across * tile_side, r0 = tile / across * tile_side;
    const std::size_t c1 = std::min(c0 + tile_side, dexels_.columns) - 1,
                      r1 = std::min(r0 + tile_side, dexels_.rows) - 1;
    Found found;
    for (; first != last; ++first) {
      const Piece& piece = pieces_[*first];
      Reach reach;
      if (!reach_of(piece, tool_.radius(), dexels_, reach)) continue;
      const double lowest = std::min(piece.from.z, piece.to.z);
      for (std::size_t row = std::max(r0, reach.r0); row <= std::min(r1, reach.r1); ++row)
        for (std::size_t column = std::max(c0, reach.c0); column <= std::min(c1, reach.c1); ++column)
          if (lowest < s_.left_[row * dexels_.columns + column]) cut(piece, column, row, found);
    }
    return found;
  }

 private:
  void cut(const Piece& piece, std::size_t column, std::size_t row, Found& found) const {
    const std::size_t d = row * dexels_.columns + column;
    const Point place = dexels_.place(column, row);
    const double z = tool_.lowest(piece, place);
    if (!(z < s_.left_[d])) return;
    if (piece.rapid) {
      const Point3 top{place.x, place.y, s_.left_[d]};
      const double depth = tool_.depth(piece, top);
      if (depth > s_.tolerance_) {
        if (found.rapids.empty() || found.rapids.back() != piece.move) found.rapids.push_back(piece.move);
        if (depth > found.rapid_cut.value) found.rapid_cut = {depth, top, piece.move};
      }
    }
    if (z < s_.part_[d] && s_.part_[d] - z > double(s_.gouge_[d])) {  // a depth is never more than the vertical one
      const Point3 point{place.x, place.y, s_.part_[d]};
      const double depth = tool_.depth(piece, point);
      if (depth > s_.tolerance_) {
        s_.gouge_[d] = std::max(s_.gouge_[d], float(depth));
        if (depth > found.gouge.value) found.gouge = {depth, point, piece.move};
      }
    }
    s_.left_[d] = std::max(z, s_.bottom_);
  }

  Simulation& s_;
  const Dexels& dexels_;
  const std::vector<Piece>& pieces_;
  const SweptTool& tool_;
};

namespace {

void measure_path(const ToolPath& path, Simulation::Report& report) {
  Point3 from = path.start;
  for (const Move& move : path.moves) {
    const double length = simulate::length_of(from, move);
    from = move.end;
    if (move.kind == MoveKind::rapid) {
      report.rapid_length += length;
      continue;
    }
    report.cutting_length += length;
    if (move.feed > 0) report.cutting_minutes += length / move.feed;
  }
}

}  // namespace

Result<Simulation> Simulation::run(const ToolPath& path, const Terrain& part, const Cutter& cutter,
                                   const StockOptions& stock, const Context& context, const Simulation* before) {
  if (Status checked = check_stock(stock, part); !checked) return checked.error();
  if (Status checked = check_path(path); !checked) return checked.error();
  const Point3 origin = part.origin(), low = part.lowest(), high = part.highest();
  Dexels dexels{{}, stock.cell, 0, 0};
  const auto lay = [&](double from, double to, double& first, std::size_t& count) {  // in the middle of the block
    count = std::size_t(std::floor((to - from + 2 * stock.margin) / stock.cell * (1 + 1e-12))) + 1;
    first = (from + to) / 2 - double(count - 1) / 2 * stock.cell;
  };
  lay(low.x, high.x, dexels.first.x, dexels.columns);
  lay(low.y, high.y, dexels.first.y, dexels.rows);

  const SweptTool tool(cutter);
  Simulation s;
  s.arc_error_ = arc_error_of_cell * stock.cell;
  const std::vector<Piece> pieces = simulate::pieces_of(path, origin, cutter.control_height(), s.arc_error_);
  if (pieces.size() >= 0xffffffff) return Error{ErrorCode::input, "the path has too many moves", "", "divide it"};
  double scale = std::max(part.extent(), cutter.radius());
  for (const Piece& piece : pieces)
    scale = std::max({scale, std::abs(piece.to.x), std::abs(piece.to.y), std::abs(piece.to.z)});
  s.columns_ = dexels.columns, s.rows_ = dexels.rows, s.cell_ = stock.cell;
  s.first_ = dexels.first;
  s.tolerance_ = rounding_of_scale * scale + (pieces.size() > path.moves.size() ? s.arc_error_ : 0);
  s.bottom_ = low.z, s.top_ = std::isnan(stock.top) ? high.z : stock.top - origin.z;
  s.left_.assign(dexels.columns * dexels.rows, s.top_);
  if (before != nullptr) {
    const bool same = before->columns_ == s.columns_ && before->rows_ == s.rows_ && before->cell_ == s.cell_ &&
                      before->top_ == s.top_ + origin.z && before->bottom_ == s.bottom_ + origin.z;
    if (!same)
      return Error{ErrorCode::usage, "the simulation to go on with is of another block", "", "give the same stock"};
    for (std::size_t d = 0; d < s.left_.size(); ++d)
      s.left_[d] = std::clamp(before->left_[d] - origin.z, s.bottom_, s.top_);
  }
  s.gouge_.assign(s.left_.size(), 0);
  s.part_ = simulate::part_heights(part, dexels, context);

  const TileLists lists = by_tile(pieces, cutter.radius(), dexels);
  std::vector<Work::Found> found(lists.begin.size() - 1);
  kernel::Progress progress(context, found.size());
  const bool done = kernel::parallel_blocks(context, found.size(), 1, [&](std::size_t t, std::size_t) {
    const std::uint32_t* const list = lists.piece.data();
    found[t] = Work(s, dexels, pieces, tool).run(t, list + lists.begin[t], list + lists.begin[t + 1]);
    progress.add(1);
  });
  if (!done || context.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
  s.conclude(found, origin);
  measure_path(path, s.report_);
  return s;
}

/// Adds up in the order of tiles and dexels, and goes over to the part's own coordinates.
template <class Found>
void Simulation::conclude(const std::vector<Found>& found, Point3 origin) {
  const auto own = [&](Extreme extreme) {
    extreme.place = {extreme.place.x + origin.x, extreme.place.y + origin.y, extreme.place.z + origin.z};
    return extreme;
  };
  std::vector<std::uint32_t> rapids;
  for (const Found& tile : found) {
    if (tile.gouge.value > report_.gouge.value) report_.gouge = own(tile.gouge);
    if (tile.rapid_cut.value > report_.rapid_cut.value) report_.rapid_cut = own(tile.rapid_cut);
    rapids.insert(rapids.end(), tile.rapids.begin(), tile.rapids.end());
  }
  std::sort(rapids.begin(), rapids.end());
  report_.cutting_rapids = std::size_t(std::unique(rapids.begin(), rapids.end()) - rapids.begin());
  report_.dexels = left_.size();
  const double area = cell_ * cell_;
  for (std::size_t d = 0; d < left_.size(); ++d) {
    report_.stock_volume += (top_ - bottom_) * area, report_.removed_volume += (top_ - left_[d]) * area;
    report_.gouged_dexels += gouge_[d] > 0;
    if (part_[d] == -infinity) continue;
    ++report_.dexels_over_part;
    if (const double rest = left_[d] - part_[d]; rest > report_.rest.value) {
      const Point at = place(d % columns_, d / columns_);
      report_.rest = own({rest, {at.x, at.y, part_[d]}, 0});
    }
  }
  first_ = {first_.x + origin.x, first_.y + origin.y};
  top_ += origin.z, bottom_ += origin.z;
  for (double& z : left_) z += origin.z;
  for (double& z : part_) z += origin.z;
}

}  // namespace krepl
