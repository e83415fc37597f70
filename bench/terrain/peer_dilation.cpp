// Grey dilation of a raster by a sampled ball, the usual way to find safe heights above an elevation model: the height
// over a sample is the greatest of (height of a sample within R) + (height of the ball there).
#include <algorithm>
#include <cmath>

#include "operations.hpp"

namespace bench {
namespace {

class Dilation : public Operation {
 public:
  explicit Dilation(const Task& task) : task_(task) {
    const krepl::Terrain::Grid& grid = task.samples.grid;
    finer_ =
        std::size_t(std::ceil(std::sqrt(grid.cell_x * grid.cell_y) / task.step - 1e-9));  // samples a side of a cell
    if (finer_ == 0) finer_ = 1;
    columns_ = (grid.columns - 1) * finer_ + 1, rows_ = (grid.rows - 1) * finer_ + 1;
    step_x_ = grid.cell_x / double(finer_), step_y_ = grid.cell_y / double(finer_);
    resample();
    for (std::ptrdiff_t j = 0; double(j) * step_y_ <= task.radius; ++j) {
      Row row;
      for (std::ptrdiff_t i = 0;; ++i) {
        const double s = task.radius * task.radius - square(double(i) * step_x_) - square(double(j) * step_y_);
        if (s < 0) break;
        row.ball.push_back(float(std::sqrt(s)));
      }
      ball_.push_back(std::move(row));
    }
  }

  bool run() override {
    heights_.assign(columns_ * rows_, -INFINITY);
    const auto rows = std::ptrdiff_t(rows_), reach = std::ptrdiff_t(ball_.size()) - 1;
    for (std::ptrdiff_t row = 0; row < rows; ++row)
      for (std::ptrdiff_t other = std::max<std::ptrdiff_t>(0, row - reach); other <= std::min(rows - 1, row + reach);
           ++other)
        raise_row(heights_.data() + row * std::ptrdiff_t(columns_), samples_.data() + other * std::ptrdiff_t(columns_),
                  ball_[std::size_t(std::abs(other - row))].ball);
    return true;
  }

  std::string facts() const override {
    const krepl::Point3 low = task_.terrain->lowest();
    const krepl::DropCutter::Raster raster{{low.x, low.y}, step_x_, step_y_, columns_, rows_};
    std::vector<double> heights(heights_.begin(), heights_.end());
    for (double& z : heights)
      if (z == -INFINITY) z = NAN;
    return ", \"points\": " + std::to_string(columns_ * rows_) + height_errors(task_, raster, heights).facts();
  }

 private:
  struct Row {
    std::vector<float> ball;  // its height at so many samples to the side
  };
  static double square(double x) { return x * x; }

  /// One row of samples lifted by one row of the ball, shift by shift, so that the compiler can take many samples at
  /// once.
  void raise_row(float* out, const float* in, const std::vector<float>& ball) const {
    for (std::size_t shift = 0; shift < std::min(ball.size(), columns_); ++shift) {
      const float lift = ball[shift];
      const std::size_t count = columns_ - shift;
      for (std::size_t i = 0; i < count; ++i) out[i] = std::max(out[i], in[i + shift] + lift);
      for (std::size_t i = 0; i < count; ++i) out[i + shift] = std::max(out[i + shift], in[i] + lift);
    }
  }

  /// The triangles' heights, cells split by the rising diagonal.
  void resample() {
    samples_.resize(columns_ * rows_);
    const Samples& s = task_.samples;
    for (std::size_t row = 0; row < rows_; ++row)
      for (std::size_t column = 0; column < columns_; ++column) {
        const std::size_t i = std::min(column / finer_, s.grid.columns - 2),
                          j = std::min(row / finer_, s.grid.rows - 2);
        const double u = double(column - i * finer_) / double(finer_), v = double(row - j * finer_) / double(finer_);
        const double a = s.at(i, j), b = u >= v ? s.at(i + 1, j) : s.at(i, j + 1), c = s.at(i + 1, j + 1);
        const double z = u >= v ? a + u * (b - a) + v * (c - b) : a + v * (b - a) + u * (c - b);
        samples_[row * columns_ + column] = std::isnan(z) ? -INFINITY : float(z);
      }
  }

  Task task_;
  std::size_t finer_, columns_, rows_;
  double step_x_, step_y_;
  std::vector<float> samples_, heights_;
  std::vector<Row> ball_;
};

}  // namespace

std::unique_ptr<Operation> make_dilation(const Task& task) { return std::make_unique<Dilation>(task); }

}  // namespace bench
