#include "simulation/simulated_fleet.hpp"

#include <cmath>
#include <limits>

#include "core/random.hpp"
#include "simulation/path_driver.hpp"

namespace smokemap {
namespace {

constexpr Stamp kSmokePeriod = 1'000'000'000;
constexpr double kQueueSpacingM = 1.5;
constexpr double kBodyOpticalDepth = 1.0;  ///< thicker smoke hides another robot
constexpr std::uint64_t kFleetStartStream = 15;

/// Places along a way, `spacing_m` apart, looking on along it.
std::vector<Pose2> places_along(const std::vector<Point2>& way, double spacing_m) {
  std::vector<Pose2> places;
  double gone = 0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Point2 step = way[i] - way[i - 1];
    gone += step.norm();
    if (gone < spacing_m * static_cast<double>(places.size() + 1)) continue;
    places.emplace_back(way[i], std::atan2(step.y(), step.x()));
  }
  return places;
}

/// Where a ray from `origin` along the unit vector `direction` enters a disc; infinity if it misses.
double range_to_disc(const Point2& origin, const Point2& direction, const Point2& center, double radius_m) {
  const Point2 to = center - origin;
  const double along = to.dot(direction), aside2 = to.squaredNorm() - along * along;
  if (along <= 0 || aside2 > radius_m * radius_m) return std::numeric_limits<double>::infinity();
  return along - std::sqrt(radius_m * radius_m - aside2);
}

}  // namespace

Result<std::vector<FleetMember>> demo_fleet(const DemoScenario& demo, int robots, const DemoParams& params) {
  if (robots < 1 || robots > kMostRobots)
    return fail(Errc::kInvalidArgument, "a fleet of " + std::to_string(robots) + " robots: 1 to " +
                                            std::to_string(kMostRobots) + " can be simulated");
  std::vector<FleetMember> members{{demo_robot_params(demo), demo.T_world_start, demo.start}};
  const auto way = PathDriver(demo.world.walls).plan(demo.T_world_start.translation(), demo.p_world_far_room);
  if (!way) return way.error();
  const std::vector<Pose2> places = places_along(*way, kQueueSpacingM);
  if (places.size() + 1 < static_cast<std::size_t>(robots))
    return fail(Errc::kDegenerate, "the way into this building is too short for " + std::to_string(robots) + " robots");
  const double finger_px = params.sigma_start_m / demo.picture.metres_per_pixel;
  for (std::size_t i = 0; members.size() < static_cast<std::size_t>(robots); ++i) {
    FleetMember member{demo_robot_params(demo), places[i], point_on_plan(demo, places[i])};
    member.params.index = members.size() + 1;
    member.params.name = "robot" + std::to_string(member.params.index);
    auto random = random_stream(demo.seed, kFleetStartStream, member.params.index);
    member.start.layout_px += Point2(normal(random, finger_px), normal(random, finger_px));
    member.start.heading_rad = wrap_angle(member.start.heading_rad + normal(random, params.sigma_start_rad));
    members.push_back(std::move(member));
  }
  return members;
}

SimulatedFleet::SimulatedFleet(SimulatedWorld world, const std::vector<FleetMember>& members, bool smoke_spreads)
    : world_(std::move(world)), smoke_spreads_(smoke_spreads) {
  for (const FleetMember& member : members) {
    robots_.emplace_back(member.params, member.T_world_start);
    T_world_last_scan_.push_back(member.T_world_start);
  }
}

std::vector<RobotOutput> SimulatedFleet::step() {
  since_smoke_ += SimulatedRobot::kStep;
  if (smoke_spreads_ && since_smoke_ >= kSmokePeriod) {
    world_.smoke.advance(to_seconds(since_smoke_));
    since_smoke_ = 0;
  }
  std::vector<RobotOutput> outputs;
  for (SimulatedRobot& robot : robots_) outputs.push_back(robot.step(world_));
  for (std::size_t i = 0; i < robots_.size(); ++i)
    for (LaserScan& scan : outputs[i].scans) {
      show_bodies(i, scan);
      T_world_last_scan_[i] = robots_[i].true_pose();
    }
  return outputs;
}

void SimulatedFleet::show_bodies(std::size_t seer, LaserScan& scan) const {
  const Pose2& T_end = robots_[seer].true_pose();
  const Pose2& T_start = scan.time_increment_s > 0 ? T_world_last_scan_[seer] : T_end;
  for (std::size_t other = 0; other < robots_.size(); ++other) {
    if (other == seer) continue;
    const Point2& body = robots_[other].true_pose().translation();
    const double radius_m = robots_[other].params().drive.radius_m;
    if ((body - T_end.translation()).norm() > scan.range_max_m + radius_m) continue;
    for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(scan.ranges_m.size());
      const Pose2 T_world_laser = interpolate(T_start, T_end, share) * scan.T_robot_laser;
      const double angle =
          T_world_laser.heading() + scan.angle_min_rad + static_cast<double>(i) * scan.angle_increment_rad;
      const Point2 direction(std::cos(angle), std::sin(angle));
      const double range_m = range_to_disc(T_world_laser.translation(), direction, body, radius_m);
      const double seen_m = scan.ranges_m[i];
      const bool echo = std::isfinite(seen_m) && seen_m > 0 && seen_m <= scan.range_max_m;
      if (!(range_m >= scan.range_min_m && range_m <= scan.range_max_m) || (echo && seen_m <= range_m)) continue;
      if (world_.smoke.optical_depth(T_world_laser.translation(), direction, range_m) > kBodyOpticalDepth) continue;
      scan.ranges_m[i] = static_cast<float>(range_m);
    }
  }
}

}  // namespace smokemap
