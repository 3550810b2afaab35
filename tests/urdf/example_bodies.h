/// Bodies of several statures and those of the real recordings, for tests of the figure.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <optional>
#include <string>
#include <variant>

#include "server/mvn/datagram.h"
#include "server/mvn/open.h"
#include "tests/shared_data.h"
#include "urdf/body_surface.h"
#include "urdf/skeleton.h"

namespace kinescope::urdf::testing {

/// A stature in metres, or a recording.
struct Body {
  const char* name;
  const char* file = nullptr;
  double height = 0;
};

inline const auto kBodies =
    ::testing::Values(Body{"Small", nullptr, 1.50}, Body{"Mean", nullptr, 1.75},
                      Body{"Tall", nullptr, 1.95}, Body{"Singer", "mvnx/test_mocap.mvnx"},
                      Body{"Meri", "mvnx/Meri-020.mvnx"}, Body{"Streamed", "udp/mxtp13.bin"});

inline std::string NameOfBody(const ::testing::TestParamInfo<Body>& body) {
  return body.param.name;
}

struct FirstSkeleton final : SampleSink {
  void OnCharacter(const Character& character) override {
    if (!skeleton) skeleton = character.skeleton;
  }
  void OnSample(const BodySample&) override {}
  void OnObjects(const ObjectsSample&) override {}
  std::optional<Skeleton> skeleton;
};

inline Skeleton SkeletonIn(const std::string& path) {
  if (path.substr(path.size() - 4) == ".bin") {  // scale data alone
    const auto message = mvn::ParseDatagram(kinescope::testing::ReadFile(path));
    const auto& scale = std::get<mvn::ScaleMessage>(message.value().body);
    std::array<Eigen::Vector3d, kSegmentCount> origins;
    for (std::size_t i = 0; i < origins.size(); ++i)
      origins[i] = scale.segments.at(i).origin_in_world;
    return SkeletonFromTPose(origins, {});
  }
  const auto source = mvn::OpenMvnx(path);
  FirstSkeleton sink;
  while (!sink.skeleton) {
    if (source->Poll(std::chrono::milliseconds(0), sink) == Source::State::kEnded) break;
  }
  return sink.skeleton.value();
}

/// Its surfaces; a test of a recording that is not there is skipped.
class BodyTest : public ::testing::TestWithParam<Body> {
 protected:
  void SetUp() override {
    const Body& body = GetParam();
    if (body.file == nullptr) {
      skeleton_ = DefaultSkeleton(body.height);
    } else {
      KINESCOPE_NEEDS_SHARED_DATA(body.file);
      skeleton_ = SkeletonIn(kinescope::testing::SharedData(body.file).string());
    }
    for (int i = 0; i < kSegmentCount; ++i) meshes_[At(i)] = SegmentMesh(skeleton_, i);
  }

  Skeleton skeleton_;
  std::array<TriangleMesh, kSegmentCount> meshes_;
};

}  // namespace kinescope::urdf::testing
