#include "maps/frame_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <string>

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

TEST(FrameTree, AFrameCalledSlashWasAChildWithoutAName) {
  FrameTree tree;
  const Eigen::Quaterniond still = Eigen::Quaterniond::Identity();
  EXPECT_FALSE(tree.set("base", "/", {0, 0, 0}, still));
  EXPECT_FALSE(tree.set("/", "laser", {0, 0, 0}, still));
  EXPECT_FALSE(tree.set("", "laser", {0, 0, 0}, still));
  EXPECT_FALSE(tree.set("/laser", "laser", {0, 0, 0}, still)) << "one frame by two names";
  EXPECT_TRUE(tree.empty());
}

TEST(FrameTree, TakesALaterWordForAnEarlierOne) {
  FrameTree tree;
  const Eigen::Quaterniond still = Eigen::Quaterniond::Identity();
  tree.set("base", "laser", {1, 0, 0}, still);
  tree.set("base", "laser", {2, 0, 0}, still);
  EXPECT_EQ(tree.lookup("base", "laser")->translation(), Eigen::Vector3d(2, 0, 0));
  tree.set("base", "mast", {0, 0, 1}, still);
  tree.set("mast", "laser", {0.5, 0, 0}, still);  // hung elsewhere: one parent only
  EXPECT_EQ(tree.lookup("base", "laser")->translation(), Eigen::Vector3d(0.5, 0, 1));
  EXPECT_FALSE(tree.set("mast", "laser", {0, std::numeric_limits<double>::infinity(), 0}, still));
  EXPECT_EQ(tree.lookup("base", "laser")->translation(), Eigen::Vector3d(0.5, 0, 1)) << "nonsense changes nothing";
}

TEST(FrameTree, FollowsLongChainsAndGivesUpOnLongCircles) {
  FrameTree chain, circle;
  const Eigen::Quaterniond still = Eigen::Quaterniond::Identity();
  constexpr int kLinks = 500;
  for (int i = 0; i < kLinks; ++i) {
    chain.set("f" + std::to_string(i), "f" + std::to_string(i + 1), {0.01, 0, 0}, still);
    circle.set("f" + std::to_string(i), "f" + std::to_string((i + 1) % kLinks), {0.01, 0, 0}, still);
  }
  EXPECT_NEAR(chain.lookup("f0", "f500")->translation().x(), 0.01 * kLinks, 1e-9);
  EXPECT_NEAR(chain.lookup("f500", "f0")->translation().x(), -0.01 * kLinks, 1e-9);
  EXPECT_NEAR(chain.lookup("f200", "f300")->translation().x(), 1, 1e-9);
  EXPECT_FALSE(circle.lookup("elsewhere", "f3"));
}

TEST(FrameTree, AnswersThereAndBackAgain) {
  std::mt19937_64 random(10);
  FrameTree tree;
  for (int i = 1; i < 30; ++i)  // a random tree
    tree.set("f" + std::to_string(uniform_index(random, static_cast<std::uint64_t>(i))), "f" + std::to_string(i),
             {normal(random, 1), normal(random, 1), normal(random, 1)}, random_rotation(random));
  for (int i = 0; i < 30; ++i)
    for (int k = 0; k < 30; ++k) {
      const std::string a = "f" + std::to_string(i), b = "f" + std::to_string(k);
      EXPECT_TRUE((*tree.lookup(a, b) * *tree.lookup(b, a)).isApprox(Eigen::Isometry3d::Identity(), 1e-9)) << a << b;
    }
}

TEST(FrameTree, MeasuresTheTiltBetweenTheSensorsPlaneAndTheFloor) {
  std::mt19937_64 random(12);
  for (int i = 0; i < 200; ++i) {
    const double heading = uniform(random, -3, 3), tilt = i < 10 ? 0 : uniform(random, 0, 1.5);
    const double towards = uniform(random, -kPi, kPi);
    const Eigen::Vector3d axis(std::cos(towards), std::sin(towards), 0);
    const bool hanging = i % 2 == 1;
    Eigen::Quaterniond q = Eigen::Quaterniond(Eigen::AngleAxisd(tilt, axis)) *
                           Eigen::Quaterniond(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()));
    if (hanging) q = q * Eigen::Quaterniond(Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()));
    FrameTree tree;
    ASSERT_TRUE(tree.set("base", "laser", {0.1, 0.2, 0.3}, q));
    const auto mount = tree.mount("base", "laser");
    EXPECT_NEAR(mount->tilt_rad, tilt, 1e-6);
    EXPECT_EQ(mount->upside_down, hanging);
    EXPECT_THAT(mount->T_robot_sensor, test::IsNear(Pose2(0.1, 0.2, heading), 1e-12, 2 * tilt + 1e-9));
  }
  EXPECT_FALSE(FrameTree().mount("base", "laser"));
}

TEST(HeadingOf, IsWhereTheXAxisPointsOnTheFloor) {
  std::mt19937_64 random(13);
  for (int i = 0; i < 300; ++i) {
    const Eigen::Quaterniond q = random_rotation(random);
    const Eigen::Vector3d x = q * Eigen::Vector3d::UnitX();
    if (x.head<2>().norm() < 1e-3) continue;  // it points at the ceiling
    EXPECT_NEAR(wrap_angle(*heading_of(q) - std::atan2(x.y(), x.x())), 0, 1e-9);
  }
}

}  // namespace
}  // namespace smokemap
