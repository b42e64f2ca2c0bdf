#include "maps/frame_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/random.hpp"
#include "tests/support/near.hpp"

namespace smokemap {
namespace {

Eigen::Quaterniond random_rotation(std::mt19937_64& random) {
  return Eigen::Quaterniond(normal(random, 1), normal(random, 1), normal(random, 1), normal(random, 1)).normalized();
}

TEST(FrameTree, ChainsTransformsOverTheCommonAncestor) {
  std::mt19937_64 random(9);
  for (int round = 0; round < 50; ++round) {
    // root -> a -> base, root -> b -> sensor
    FrameTree tree;
    std::map<std::string, Eigen::Isometry3d> T_root;
    T_root["root"] = Eigen::Isometry3d::Identity();
    const std::pair<const char*, const char*> links[] = {{"root", "a"}, {"a", "base"}, {"root", "b"}, {"b", "sensor"}};
    for (const auto& [parent, child] : links) {
      const Eigen::Vector3d t(normal(random, 2), normal(random, 2), normal(random, 2));
      const Eigen::Quaterniond q = random_rotation(random);
      ASSERT_TRUE(tree.set(parent, child, t, q));
      Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
      T.linear() = q.toRotationMatrix();
      T.translation() = t;
      T_root[child] = T_root[parent] * T;
    }
    for (const auto& [from, T_root_from] : T_root)
      for (const auto& [to, T_root_to] : T_root) {
        const auto found = tree.lookup(from, to);
        ASSERT_TRUE(found) << from << " " << to;
        EXPECT_TRUE(found->isApprox(T_root_from.inverse() * T_root_to, 1e-9)) << from << " " << to;
      }
  }
}

TEST(FrameTree, HasNoAnswerForFramesThatAreNotConnectedOrGoInCircles) {
  FrameTree tree;
  const Eigen::Quaterniond still = Eigen::Quaterniond::Identity();
  tree.set("base", "laser", {0, 0, 0}, still);
  tree.set("other", "radar", {0, 0, 0}, still);
  tree.set("snake", "tail", {0, 0, 0}, still);
  tree.set("tail", "snake", {0, 0, 0}, still);
  EXPECT_FALSE(tree.lookup("base", "radar"));
  EXPECT_FALSE(tree.lookup("base", "tail"));
  EXPECT_FALSE(tree.lookup("nobody", "laser"));
  EXPECT_TRUE(tree.lookup("snake", "tail"));
  EXPECT_TRUE(tree.knows("base"));
  EXPECT_FALSE(tree.knows("nobody"));
}

TEST(FrameTree, RefusesWhatIsNoRigidMotion) {
  FrameTree tree;
  const Eigen::Quaterniond still = Eigen::Quaterniond::Identity();
  EXPECT_FALSE(tree.set("a", "b", {std::nan(""), 0, 0}, still));
  EXPECT_FALSE(tree.set("a", "b", {0, 0, 0}, Eigen::Quaterniond(0, 0, 0, 0)));
  EXPECT_FALSE(tree.set("a", "b", {0, 0, 0}, Eigen::Quaterniond(2, 0, 0, 0)));
  EXPECT_FALSE(tree.set("a", "a", {0, 0, 0}, still));
  EXPECT_FALSE(tree.set("a", "", {0, 0, 0}, still));
  EXPECT_TRUE(tree.empty());
  EXPECT_TRUE(tree.set("/a", "/b", {1, 0, 0}, still));
  EXPECT_TRUE(tree.lookup("a", "b")) << "a leading slash is a habit, not a name";
}

TEST(FrameTree, TellsHowASensorSitsOnTheFloorPlan) {
  FrameTree tree;
  const auto about = [](double angle, const Eigen::Vector3d& axis) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
  };
  tree.set("base", "upright", {1, 2, 3}, about(0.5, Eigen::Vector3d::UnitZ()));
  tree.set("base", "hanging", {0, 0, 0}, about(0.5, Eigen::Vector3d::UnitZ()) * about(kPi, Eigen::Vector3d::UnitX()));
  tree.set("base", "leaning", {0, 0, 0}, about(0.25, Eigen::Vector3d::UnitY()));
  EXPECT_THAT(tree.mount("base", "upright")->T_robot_sensor, test::IsNear(Pose2(1, 2, 0.5), 1e-12, 1e-12));
  EXPECT_FALSE(tree.mount("base", "upright")->upside_down);
  EXPECT_TRUE(tree.mount("base", "hanging")->upside_down);
  EXPECT_NEAR(tree.mount("base", "hanging")->T_robot_sensor.heading(), 0.5, 1e-12);
  EXPECT_NEAR(tree.mount("base", "leaning")->tilt_rad, 0.25, 1e-9);
}

TEST(HeadingOf, UndoesARotationAboutZForEveryHeadingAndScale) {
  for (double heading = -3.1; heading < 3.1; heading += 0.1) {
    const Eigen::Quaterniond q(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()));
    EXPECT_NEAR(*heading_of(q), heading, 1e-12);
    EXPECT_NEAR(*heading_of(Eigen::Quaterniond(-3 * q.coeffs())), heading, 1e-12);
  }
  EXPECT_FALSE(heading_of(Eigen::Quaterniond(0, 0, 0, 0)));
  EXPECT_FALSE(heading_of(Eigen::Quaterniond(std::nan(""), 0, 0, 1)));
}

}  // namespace
}  // namespace smokemap
