/// One sample while its datagrams come in: which types and parts are there, and what they said.
/// One thread, allocates nothing.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>

#include "core/body_sample.h"
#include "server/mvn/arrival.h"
#include "server/mvn/datagram.h"

namespace kinescope::mvn {

/// The message types that make up a sample, as small numbers.
enum SampleType : int {
  kPoseType,
  kEulerType,
  kMarkersType,
  kAnglesType,
  kLinearType,
  kAngularType,
  kTrackersType,
  kComType,
  kTimeCodeType,
};
inline constexpr int kSampleTypeCount = 9;
using SampleTypes = std::bitset<kSampleTypeCount>;
using SampleDigests = std::array<std::uint32_t, kSampleTypeCount>;

/// The SampleType of a message; nullopt for 12 and 13, which belong to no sample.
std::optional<SampleType> SampleTypeOf(Type type);

class PendingSample {
 public:
  /// A new sample, of the counter and time code in `header`; everything before is forgotten.
  void Begin(const Header& header, const Arrival& arrival);

  enum class Added {
    kYes,
    kDuplicate,      // the same bytes again
    kOther,          // another message in the place of one that is there
    kContradiction,  // part numbers that cannot be
  };

  /// Takes over what `message` says; `digest` stands for its bytes. @pre it is of a SampleType.
  Added Add(const Message& message, std::uint32_t digest, std::int64_t now_nanos);

  std::uint32_t counter() const { return sample_.counter; }
  std::uint32_t time_code_millis() const {
    return static_cast<std::uint32_t>(sample_.time_code_millis);
  }
  const Arrival& first_arrival() const { return first_arrival_; }
  std::uint64_t datagrams() const { return datagrams_; }
  SampleTypes begun() const;                                 // at least one part is there
  SampleTypes whole() const;                                 // all parts are there
  const SampleDigests& digests() const { return digests_; }  // of first parts
  int odd_ids() const { return odd_ids_; }

  bool HasPose() const;     // all 23 segments: 02, or 21 and 22, or 01
  bool HasObjects() const;  // a whole 02 of a few things that are no body

  /// The sample as far as it is known, without stamp and character. @pre HasPose()
  BodySample TakeBody() const;
  /// Likewise. @pre HasObjects()
  ObjectsSample TakeObjects() const;

 private:
  struct Parts {
    std::bitset<128> came;
    int last = -1;  // number of the last part; -1: not known yet
    bool whole() const;
  };

  void Store(const PoseMessage& body);
  void Store(const EulerPoseMessage& body);
  void Store(const LinearMessage& body);
  void Store(const AngularMessage& body);
  void Store(const JointAnglesMessage& body);
  void Store(const TrackersMessage& body);
  void Store(const CenterOfMassMessage& body);
  void Store(const TimeCodeMessage& body);
  template <class Other>
  void Store(const Other&) {}  // markers: checked, and nothing that a pose does not say better

  using Slots = std::bitset<kSlotCount>;
  static bool IsBody(const Slots& slots);
  bool IsWhole(SampleType type) const { return parts_[static_cast<std::size_t>(type)].whole(); }

  std::array<Parts, kSampleTypeCount> parts_;
  SampleDigests digests_{};
  std::uint64_t datagrams_ = 0;
  int body_segments_ = 0;  // as the header of 02 says
  int odd_ids_ = 0;
  Arrival first_arrival_;
  BodySample sample_;  // all but its poses
  Slots posed_, euler_posed_, linear_, angular_;
  std::array<urdf::Pose, kSlotCount> poses_{};          // of 02
  std::array<urdf::Pose, kSlotCount> euler_poses_{};    // of 01
  std::array<urdf::Pose, kSlotCount> derived_poses_{};  // positions of 21, orientations of 22
  std::array<Eigen::Vector3d, urdf::kJointCount> angles_{};
  std::bitset<urdf::kJointCount> angled_;
};

}  // namespace kinescope::mvn
