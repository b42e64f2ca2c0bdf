#include "localization/localizer.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <tuple>

#include "core/check.hpp"
#include "core/random.hpp"
#include "grids/distance_map.hpp"

namespace smokemap {
namespace {

constexpr double kBin_m = 0.5;
constexpr double kBin_rad = 0.175;
constexpr double kParticlesPerBin = 12;  ///< about what KLD asks for at 5 % error and 99 % confidence, per occupied bin
constexpr double kRandomShare = 0.02;    ///< of the particles start anew when the walls do not explain what is seen
constexpr double kScaleDrift = 0.005;
constexpr double kExplained = 1.25;  ///< sigmas from a face within which a hit counts as explained
constexpr double kForget = 0.3;      ///< weight of the newest scan in the running share of explained hits
constexpr double kFar_m = 1.5;       ///< farther from any wall is all the same

struct Particle {
  Pose2 T_map_robot;
  double log_scale = 0;  ///< local stretch of the walls around it
  double log_weight = 0;
};

}  // namespace

Result<Ok> LocalizerParams::validate() const {
  return ParamCheck("LocalizerParams")
      .in_range("min_particles", min_particles, 10, max_particles)
      .in_range("max_particles", max_particles, 10, 1e6)
      .positive("sigma_hit_m", sigma_hit_m)
      .in_range("outlier_share", outlier_share, 0.01, 0.99)
      .in_range("temper", temper, 0.001, 1)
      .in_range("beams", beams, 5, 10000)
      .in_range("resolution_m", resolution_m, 0.01, 1)
      .in_range("scale_sigma", scale_sigma, 0, 0.5)
      .in_range("lost_below", lost_below, 0, 1)
      .positive("lost_sigma_m", lost_sigma_m)
      .result();
}

class Localizer::Impl {
 public:
  Impl(const LocalizerParams& p, std::uint64_t seed) : params(p), random(random_stream(seed, 0x10ca1)) {}

  Particle anywhere();
  void move(const Pose2& step);
  void weigh(const std::vector<Point2>& hits);
  void resample();
  int wanted_particles() const;
  LocalizerEstimate estimate() const;

  LocalizerParams params;
  std::mt19937_64 random;
  DistanceMap walls;                                   ///< to the nearest face
  Point2 low = Point2::Zero(), high = Point2::Zero();  ///< box around the walls
  std::vector<Particle> particles;
  double explained = 0;
  bool poor = false;  ///< the walls did not explain the last scan
};

Particle Localizer::Impl::anywhere() {
  const Point2 size = high - low;
  Particle p;
  p.T_map_robot =
      Pose2(low.x() + uniform01(random) * size.x(), low.y() + uniform01(random) * size.y(), uniform(random, -kPi, kPi));
  p.log_scale = normal(random, params.scale_sigma);
  return p;
}

/// Noise in the robot's own axes, in proportion to what it drove and turned.
void Localizer::Impl::move(const Pose2& step) {
  const double sigma_m = params.sigma_move_share * step.translation().norm() + params.sigma_move_m;
  const double sigma_rad =
      params.sigma_turn_share * std::abs(step.heading()) + params.sigma_turn_rad + 0.02 * step.translation().norm();
  for (Particle& p : particles) {
    const Pose2 noisy(step.x() + normal(random, sigma_m), step.y() + normal(random, sigma_m),
                      step.heading() + normal(random, sigma_rad));
    p.T_map_robot = p.T_map_robot * noisy;
    p.log_scale =
        std::clamp(p.log_scale + normal(random, kScaleDrift), -2.5 * params.scale_sigma, 2.5 * params.scale_sigma);
  }
}

void Localizer::Impl::weigh(const std::vector<Point2>& hits) {
  std::vector<Point2> beams;
  const std::size_t step = std::max<std::size_t>(1, hits.size() / static_cast<std::size_t>(params.beams));
  for (std::size_t i = 0; i < hits.size(); i += step)
    if (hits[i].allFinite()) beams.push_back(hits[i]);
  if (beams.size() < 5) return;
  const double precision = -0.5 / (params.sigma_hit_m * params.sigma_hit_m);
  double best = -1e300;
  std::size_t best_explained = 0;
  for (Particle& p : particles) {
    const double c = std::cos(p.T_map_robot.heading()), s = std::sin(p.T_map_robot.heading());
    // A plan drawn too large locally sees the same hits farther away.
    const double stretch = std::exp(p.log_scale);
    double log_likelihood = 0;
    std::size_t near = 0;
    for (const Point2& b : beams) {
      const double d = walls.at({p.T_map_robot.x() + stretch * (c * b.x() - s * b.y()),
                                 p.T_map_robot.y() + stretch * (s * b.x() + c * b.y())});
      log_likelihood += std::log(params.outlier_share + (1 - params.outlier_share) * std::exp(precision * d * d));
      near += d < kExplained * params.sigma_hit_m;
    }
    p.log_weight += params.temper * log_likelihood;
    if (p.log_weight > best) best = p.log_weight, best_explained = near;
  }
  for (Particle& p : particles) p.log_weight -= best;
  explained += kForget * (static_cast<double>(best_explained) / static_cast<double>(beams.size()) - explained);
  poor = explained < params.lost_below;
}

int Localizer::Impl::wanted_particles() const {
  std::set<std::tuple<int, int, int>> bins;
  for (const Particle& p : particles)
    bins.insert({static_cast<int>(std::floor(p.T_map_robot.x() / kBin_m)),
                 static_cast<int>(std::floor(p.T_map_robot.y() / kBin_m)),
                 static_cast<int>(std::floor(p.T_map_robot.heading() / kBin_rad))});
  return std::clamp(static_cast<int>(kParticlesPerBin * static_cast<double>(bins.size())), params.min_particles,
                    params.max_particles);
}

/// Systematic, when the effective number has halved.
void Localizer::Impl::resample() {
  double sum = 0, squares = 0;
  for (const Particle& p : particles) sum += std::exp(p.log_weight), squares += std::exp(2 * p.log_weight);
  if (!(sum > 0) || sum * sum / squares > 0.5 * static_cast<double>(particles.size())) return;
  std::vector<Particle> next;
  const int draw = std::min(wanted_particles(), static_cast<int>(params.max_particles));
  const double stride = sum / draw;
  double at = uniform01(random) * stride, passed = 0;
  std::size_t i = 0;
  for (int k = 0; k < draw; ++k, at += stride) {
    while (i + 1 < particles.size() && passed + std::exp(particles[i].log_weight) < at)
      passed += std::exp(particles[i++].log_weight);
    next.push_back(particles[i]);
    next.back().log_weight = 0;
  }
  if (poor)
    for (std::size_t k = 0; k < next.size(); ++k)
      if (uniform01(random) < kRandomShare) next[k] = anywhere();
  particles = std::move(next);
  particles.resize(std::min(particles.size(), static_cast<std::size_t>(wanted_particles())));
}

LocalizerEstimate Localizer::Impl::estimate() const {
  LocalizerEstimate out;
  out.particles = static_cast<int>(particles.size());
  if (particles.empty()) return out;
  double sum = 0;
  Eigen::Vector4d mean = Eigen::Vector4d::Zero();
  for (const Particle& p : particles) {
    const double w = std::exp(p.log_weight);
    sum += w;
    mean += w * Eigen::Vector4d(p.T_map_robot.x(), p.T_map_robot.y(), std::cos(p.T_map_robot.heading()),
                                std::sin(p.T_map_robot.heading()));
  }
  mean /= sum;
  out.T_map_robot = Pose2(mean[0], mean[1], std::atan2(mean[3], mean[2]));
  out.covariance.setZero();
  for (const Particle& p : particles) {
    Eigen::Vector3d d = p.T_map_robot.vector() - out.T_map_robot.vector();
    d[2] = wrap_angle(d[2]);
    out.covariance += std::exp(p.log_weight) / sum * d * d.transpose();
  }
  out.covariance += Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
  out.explained = explained;
  const double spread = std::sqrt(0.5 * (out.covariance(0, 0) + out.covariance(1, 1)));
  out.lost = walls.empty() || poor || spread > params.lost_sigma_m;
  return out;
}

Localizer::Localizer(const LocalizerParams& params, std::uint64_t seed) : impl_(std::make_unique<Impl>(params, seed)) {
  ENGINE_EXPECT(params.validate().ok());
}
Localizer::~Localizer() = default;
Localizer::Localizer(Localizer&&) noexcept = default;
Localizer& Localizer::operator=(Localizer&&) noexcept = default;

void Localizer::set_walls(const std::vector<LocalizerWall>& walls) {
  std::vector<EndPoints> faces;
  for (const LocalizerWall& w : walls) {
    if (!w.segment.a.allFinite() || !w.segment.b.allFinite() || w.segment.length() < 0.01) continue;
    const Point2 half = 0.5 * w.thickness_m * w.segment.normal();
    faces.push_back({w.segment.a + half, w.segment.b + half});
    faces.push_back({w.segment.a - half, w.segment.b - half});
  }
  impl_->walls = faces.empty() ? DistanceMap() : DistanceMap::from_segments(faces, impl_->params.resolution_m, kFar_m);
  if (faces.empty()) return;
  impl_->low = impl_->high = faces.front().first;
  for (const EndPoints& f : faces)
    for (const Point2& p : {f.first, f.second})
      impl_->low = impl_->low.cwiseMin(p), impl_->high = impl_->high.cwiseMax(p);
}

void Localizer::start_at(const Pose2& T_map_robot, double sigma_m, double sigma_rad) {
  impl_->particles.clear();
  for (int i = 0; i < std::min(4 * impl_->params.min_particles, impl_->params.max_particles); ++i) {
    Particle p;
    p.T_map_robot = T_map_robot * Pose2(normal(impl_->random, sigma_m), normal(impl_->random, sigma_m),
                                        normal(impl_->random, sigma_rad));
    p.log_scale = normal(impl_->random, impl_->params.scale_sigma);
    impl_->particles.push_back(p);
  }
  impl_->explained = 1;
  impl_->poor = false;
}

void Localizer::start_anywhere() {
  impl_->particles.clear();
  for (int i = 0; i < impl_->params.max_particles; ++i) impl_->particles.push_back(impl_->anywhere());
  impl_->explained = 0;
  impl_->poor = false;
}

void Localizer::update(const Pose2& T_before_after, const std::vector<Point2>& hits_robot) {
  if (impl_->particles.empty() || impl_->walls.empty() || !T_before_after.is_finite()) return;
  impl_->move(T_before_after);
  impl_->weigh(hits_robot);
  impl_->resample();
}

LocalizerEstimate Localizer::estimate() const { return impl_->estimate(); }

}  // namespace smokemap
