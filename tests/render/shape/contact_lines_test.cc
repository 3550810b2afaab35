// Creases of a drawing: where a posed surface meets itself.
#include "render/shape/contact_lines.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/shape/face_lines.h"
#include "render/shape/smooth_line.h"
#include "render/shape/triangle_pairs.h"
#include "tests/urdf/skin_postures.h"

namespace kinescope::render {
namespace {

using Eigen::Vector3f;

struct Sheets {
  std::vector<Vector3f> positions;
  std::vector<std::uint32_t> triangles;
};

// Squares of 1 cm, 10 x 10, from `corner` along `x` and `y`.
void AddSheet(const Vector3f& corner, const Vector3f& x, const Vector3f& y, Sheets& sheets) {
  constexpr std::uint32_t kSide = 10;
  const auto first = static_cast<std::uint32_t>(sheets.positions.size());
  for (std::uint32_t row = 0; row <= kSide; ++row) {
    for (std::uint32_t column = 0; column <= kSide; ++column) {
      sheets.positions.emplace_back(corner + 0.01f * static_cast<float>(column) * x +
                                    0.01f * static_cast<float>(row) * y);
    }
  }
  for (std::uint32_t row = 0; row < kSide; ++row) {
    for (std::uint32_t column = 0; column < kSide; ++column) {
      const std::uint32_t a = first + row * (kSide + 1) + column, b = a + 1, c = a + kSide + 1,
                          d = c + 1;
      sheets.triangles.insert(sheets.triangles.end(), {a, b, d, a, d, c});
    }
  }
}

// One lies in the plane z = 0, the other stands on y = 0.0512 and reaches `below` under it, m.
Sheets Crossing(float below) {
  Sheets sheets;
  AddSheet({0, 0, 0}, Vector3f::UnitX(), Vector3f::UnitY(), sheets);
  AddSheet({0.0034f, 0.0512f, -below}, Vector3f::UnitX(), Vector3f::UnitZ(), sheets);
  return sheets;
}

Sheets Apart() { return Crossing(-0.5f); }

TEST(ContactLines, RunWhereSurfacesCross) {
  const Sheets sheets = Crossing(0.0237f);
  const auto lines = ContactLines(sheets.positions, Apart().positions, sheets.triangles);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_FALSE(lines[0].is_loop);
  EXPECT_NEAR(LengthOf(lines[0]), 0.0966, 1e-4);
  for (const Vector3f& p : lines[0].points) {
    EXPECT_NEAR(p.y(), 0.0512, 1e-5);
    EXPECT_NEAR(p.z(), 0, 1e-5);
  }
}

TEST(ContactLines, AreNoneWhereNothingMeets) {
  const Sheets sheets = Crossing(-0.001f);
  EXPECT_TRUE(ContactLines(sheets.positions, Apart().positions, sheets.triangles).empty());
  EXPECT_TRUE(ContactLines({}, {}, {}).empty());
}

TEST(ContactLines, AreNoneBetweenPartsThatMeetAtRestToo) {
  const Sheets sheets = Crossing(0.0237f);
  std::vector<Vector3f> rest(sheets.positions.size(), Vector3f::Zero());
  EXPECT_TRUE(ContactLines(sheets.positions, rest, sheets.triangles).empty());
}

TEST(NearPairs, AreThoseOfAllPairsWhoseBoxesOverlap) {
  const Sheets sheets = Crossing(0.0237f);
  const std::vector<Vector3f> rest = Apart().positions;
  std::size_t expected = 0;
  const auto overlap = [&](std::size_t a, std::size_t b) {
    Eigen::AlignedBox3f of_a, of_b;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      of_a.extend(sheets.positions[sheets.triangles[3 * a + corner]]);
      of_b.extend(sheets.positions[sheets.triangles[3 * b + corner]]);
    }
    return of_a.intersects(of_b);
  };
  const std::size_t half = sheets.triangles.size() / 6;  // of the triangles: one sheet
  for (std::size_t a = 0; a < half; ++a) {
    for (std::size_t b = half; b < 2 * half; ++b) expected += overlap(a, b) ? 1 : 0;
  }
  EXPECT_GT(expected, 20u);
  EXPECT_EQ(NearPairs(sheets.positions, rest, sheets.triangles, 0.2f).size(), expected);
}

TEST(Smoothed, TakesShortWavesFromALineAndLeavesLongOnes) {
  SurfaceLine circle{{}, true};  // 20 cm around, with waves of 5 mm
  constexpr int kPoints = 160;
  const float radius = 0.1f / static_cast<float>(M_PI);
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2 * M_PI * i / kPoints;
    const auto r = static_cast<float>(radius + 0.001 * std::sin(40 * angle));
    circle.points.emplace_back(r * static_cast<float>(std::cos(angle)),
                               r * static_cast<float>(std::sin(angle)), 1);
  }
  const SurfaceLine calm = Smoothed(circle, 0.02);
  EXPECT_TRUE(calm.is_loop);
  EXPECT_GT(calm.points.size(), 40u);
  for (const Vector3f& p : calm.points) EXPECT_NEAR(p.head<2>().norm(), radius, 2e-4);
}

TEST(Smoothed, KeepsTheEndsOfAnOpenLine) {
  SurfaceLine line;
  for (int i = 0; i <= 50; ++i) {
    line.points.emplace_back(0.01f * static_cast<float>(i), i % 2 == 0 ? 0.0f : 0.002f, 0.0f);
  }
  const SurfaceLine calm = Smoothed(line, 0.05);
  EXPECT_EQ(calm.points.front(), line.points.front());
  EXPECT_EQ(calm.points.back(), line.points.back());
}

std::vector<std::uint32_t> SkinTriangles() {
  std::vector<std::uint32_t> triangles;
  for (const skin::Triangle& t : skin::BuiltInSkin().triangles) {
    triangles.insert(triangles.end(), t.begin(), t.end());
  }
  return triangles;
}

std::vector<SurfaceLine> WithKneeAt(const skin::PersonSkin& skin, double degrees) {
  skin::PersonSkin::Surface surface;
  skin.Pose(skin::TurnedAt(skin.bind().links, urdf::jLeftKnee, Eigen::Vector3d::UnitY(), degrees),
            {}, surface);
  return ContactLines(surface.positions, skin.rest(), SkinTriangles());
}

TEST(ContactLines, RunBetweenCalfAndThighOfABentKneeAndNowhereElse) {
  for (const bool is_woman : {false, true}) {
    const skin::PersonSkin skin = skin::SkinOf(is_woman, 1.7, 70);
    EXPECT_TRUE(WithKneeAt(skin, 0).empty());
    EXPECT_TRUE(WithKneeAt(skin, 60).empty());
    const auto lines = WithKneeAt(skin, 140);
    ASSERT_EQ(lines.size(), 1u);
    const Eigen::Vector3d knee = skin.bind().links[urdf::kLeftLowerLeg].position;
    for (const Vector3f& p : lines[0].points) {
      EXPECT_LT((p.cast<double>() - knee).norm(), 0.25);
      EXPECT_LT(p.x(), knee.x()) << "behind the knee";
    }
  }
}

// A line that begins long would flicker.
TEST(ContactLines, GrowWithTheBend) {
  const skin::PersonSkin skin = skin::SkinOf(false, 1.75, 75);
  const auto length_at = [&](double degrees) {
    double length = 0;
    for (const SurfaceLine& line : WithKneeAt(skin, degrees)) length += LengthOf(line);
    return length;
  };
  double before = length_at(80);
  for (double degrees = 85; degrees <= 150; degrees += 5) {
    const double length = length_at(degrees);
    EXPECT_LT(std::abs(length - before), 0.1) << "m, at " << degrees << " degrees";
    before = length;
  }
  EXPECT_GT(before, 0.3);
}

TEST(FaceLines, LieOnTheFrontOfTheFaceAndAreSymmetrical) {
  for (const skin::Build& build : {skin::Build{0, 0}, skin::Build{1, 0.5}}) {
    const std::vector<Vector3f> rest = skin::BuiltInSkin().Blend(build);
    const auto lines = FaceLines(skin::BuiltInSkin(), build).On(rest);
    ASSERT_EQ(lines.size(), 7u);
    const Eigen::Vector3d head =
        skin::BindPoseOf(urdf::DefaultSkeleton()).links[urdf::kHead].position;
    double left = 0, right = 0;
    for (const SurfaceLine& line : lines) {
      EXPECT_GT(LengthOf(line), 0.015);
      EXPECT_LT(LengthOf(line), 0.06) << "does not jump";
      for (const Vector3f& p : line.points) {
        const Eigen::Vector3d away = p.cast<double>() - head;
        EXPECT_GT(away.x(), 0.06);
        left = std::max(left, away.y());
        right = std::max(right, -away.y());
      }
    }
    EXPECT_NEAR(left, right, 1e-4);
  }
}

}  // namespace
}  // namespace kinescope::render
