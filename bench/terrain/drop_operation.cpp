#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>

#include "operations.hpp"

namespace bench {
namespace {

using krepl::DropCutter;
using krepl::Point;
using krepl::Point3;

std::string point_facts(std::size_t points) { return ", \"points\": " + std::to_string(points); }

/// Making the hierarchy.
class Build : public Operation {
 public:
  explicit Build(const Task& task) : task_(task) {}
  bool run() override {
    cutter_.reset();
    auto cutter = DropCutter::build(task_.terrain, task_.radius, task_.context());
    if (!cutter) return std::fprintf(stderr, "krepl: %s\n", cutter.error().text().c_str()), false;
    cutter_ = std::move(*cutter);
    return true;
  }
  std::string facts() const override { return ""; }
  const DropCutter& cutter() const { return *cutter_; }

 private:
  Task task_;
  std::optional<DropCutter> cutter_;
};

class RasterDrop : public Operation {
 public:
  RasterDrop(const Task& task, const DropCutter& cutter, const DropCutter::Raster& raster)
      : task_(task), cutter_(cutter), raster_(raster), contacts_(raster.columns * raster.rows) {}
  bool run() override { return cutter_.at(raster_, contacts_, task_.context()).ok(); }
  std::string facts() const override { return point_facts(contacts_.size()); }

 private:
  Task task_;
  DropCutter cutter_;
  DropCutter::Raster raster_;
  std::vector<DropCutter::Contact> contacts_;
};

/// Over all of the terrain, a place a cell. Places are not those of samples, where a ball touches more things at once.
DropCutter::Raster over_cells(const Task& task) {
  const double x = task.samples.grid.cell_x, y = task.samples.grid.cell_y;
  const Point3 low = task.terrain->lowest();
  return {{low.x + 0.31 * x, low.y + 0.47 * y}, x, y, task.samples.grid.columns - 1, task.samples.grid.rows - 1};
}

/// At most 600 x 600 places in the middle, four a cell along each side.
DropCutter::Raster quarters(const Task& task) {
  DropCutter::Raster raster = over_cells(task);
  raster.step_x /= 4, raster.step_y /= 4;
  const std::size_t columns = std::min<std::size_t>(600, 4 * raster.columns),
                    rows = std::min<std::size_t>(600, 4 * raster.rows);
  raster.first.x += raster.step_x * double((4 * raster.columns - columns) / 2);
  raster.first.y += raster.step_y * double((4 * raster.rows - rows) / 2);
  raster.columns = columns, raster.rows = rows;
  return raster;
}

/// Anywhere above the terrain, in random order.
class RandomDrop : public Operation {
 public:
  RandomDrop(const Task& task, const DropCutter& cutter, bool one_by_one)
      : task_(task), cutter_(cutter), one_by_one_(one_by_one) {
    std::mt19937_64 random(2);
    const Point3 low = task.terrain->lowest(), high = task.terrain->highest();
    std::uniform_real_distribution<double> x(low.x, high.x), y(low.y, high.y);
    for (int i = 0; i < 100'000; ++i) {
      const double at_x = x(random);
      places_.push_back({at_x, y(random)});
    }
    contacts_.resize(places_.size());
  }
  bool run() override {
    if (!one_by_one_) return cutter_.at(places_, contacts_, task_.context()).ok();
    for (std::size_t i = 0; i < places_.size(); ++i) contacts_[i] = cutter_.at(places_[i]);
    return true;
  }
  std::string facts() const override { return point_facts(places_.size()); }

 private:
  Task task_;
  DropCutter cutter_;
  bool one_by_one_;
  std::vector<Point> places_;
  std::vector<DropCutter::Contact> contacts_;
};

}  // namespace

std::unique_ptr<Operation> make_drop(const Task& task, const std::string& way) {
  auto build = std::make_unique<Build>(task);
  if (way == "build") return build;
  if (!build->run()) return nullptr;
  if (way == "cells") return std::make_unique<RasterDrop>(task, build->cutter(), over_cells(task));
  if (way == "quarters") return std::make_unique<RasterDrop>(task, build->cutter(), quarters(task));
  if (way == "list" || way == "single") return std::make_unique<RandomDrop>(task, build->cutter(), way == "single");
  return nullptr;
}

std::string HeightErrors::facts() const {
  char text[200];
  std::snprintf(text, sizeof text, ", \"compared\": %zu, \"largest_error\": %.9g, \"mean_error\": %.9g", places,
                largest, mean);
  return text;
}

HeightErrors height_errors(const Task& task, const DropCutter::Raster& raster, const std::vector<double>& heights) {
  HeightErrors errors;
  const auto cutter = DropCutter::build(task.terrain, task.radius);
  if (!cutter) return errors;
  // An odd stride meets all places within a cell that is divided into a power of two.
  const std::size_t stride = std::size_t(std::sqrt(double(heights.size()) / 1e6)) | 1;
  DropCutter::Raster row = raster;
  row.columns = (raster.columns + stride - 1) / stride, row.rows = 1, row.step_x *= double(stride);
  std::vector<DropCutter::Contact> contacts(row.columns);
  const double origin = task.terrain->origin().z;
  for (std::size_t j = 0; j < raster.rows; j += stride) {
    row.first = raster.place(0, j);
    if (!cutter->at(row, contacts, task.context())) return {};
    for (std::size_t i = 0; i < row.columns; ++i) {
      const double height = heights[j * raster.columns + i * stride];
      if (!contacts[i].touches() || std::isnan(height)) continue;
      const double error = std::abs(contacts[i].height + origin - height);
      errors.largest = std::max(errors.largest, error), errors.mean += error, ++errors.places;
    }
  }
  errors.mean /= double(std::max<std::size_t>(errors.places, 1));
  return errors;
}

}  // namespace bench
