/// One sample while its datagrams come in: which types and parts are there, and what they said.
/// One thread, allocates nothing.
#pragma once

#include <bitset>
#include <cstdint>

#include "server/core/body_sample.h"
#include "server/mvn/arrival.h"
#include "server/mvn/datagram.h"

namespace kinescope::mvn {

/// The message types that make up a sample, as small numbers.
enum SampleType : int { kPoseType, kAnglesType, kLinearType, kAngularType, kComType };
inline constexpr int kSampleTypeCount = 5;
using SampleTypes = std::bitset<kSampleTypeCount>;

class PendingSample {
 public:
  /// A new sample, of the counter and time code in `header`; everything before is forgotten.
  void Begin(const Header& header, const Arrival& arrival);

  enum class Added { kYes, kDuplicate, kContradiction };

  /// Takes over what `message` says. @pre its body is of a SampleType.
  Added Add(const Message& message, std::int64_t now_nanos);

  static SampleType TypeOf(const Message& message);

  std::uint32_t counter() const { return sample_.counter; }
  const Arrival& first_arrival() const { return first_arrival_; }
  std::uint64_t datagrams() const { return datagrams_; }
  bool Has(const Message& message) const;  // the same type and part
  SampleTypes begun() const;               // at least one part is there
  SampleTypes whole() const;               // all parts are there
  bool HasPose() const;                    // all 23 segments: 02, or 21 and 22

  /// The sample as far as it is known, without stamp and character. @pre HasPose()
  BodySample Take() const;

 private:
  struct Parts {
    std::bitset<128> came;
    int last = -1;  // number of the last part; -1: not known yet
    bool whole() const;
  };

  void Store(const PoseMessage& body);
  void Store(const LinearMessage& body);
  void Store(const AngularMessage& body);
  void Store(const JointAnglesMessage& body);
  void Store(const CenterOfMassMessage& body);
  template <class Other>
  void Store(const Other&) {}

  std::array<Parts, kSampleTypeCount> parts_;
  std::uint64_t datagrams_ = 0;
  Arrival first_arrival_;
  BodySample sample_;  // its segments' poses are those of 02
  std::bitset<urdf::kSegmentCount> posed_, linear_, angular_;
  std::array<Eigen::Vector3d, urdf::kSegmentCount> linear_position_{};         // of 21
  std::array<Eigen::Quaterniond, urdf::kSegmentCount> angular_orientation_{};  // of 22
  std::array<Eigen::Vector3d, urdf::kJointCount> angles_{};
  std::bitset<urdf::kJointCount> angled_;
};

}  // namespace kinescope::mvn
