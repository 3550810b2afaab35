/// Collects one sample while its datagrams arrive: types and parts received so far, and their
/// values. One thread, no allocation.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>

#include "core/body_sample.h"
#include "server/mvn/arrival.h"
#include "server/mvn/datagram.h"

namespace kinescope::mvn {

/// The message types of a sample as consecutive numbers.
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
  /// Starts a new sample with the counter and time code of `header`; discards everything before.
  void Begin(const Header& header, const Arrival& arrival);

  enum class Added {
    kYes,
    kDuplicate,      // the same bytes again
    kOther,          // another message with the same place
    kContradiction,  // impossible part numbers
  };

  /// Adds the values of `message`; `digest` identifies its bytes. @pre its type has a SampleType.
  Added Add(const Message& message, std::uint32_t digest, std::int64_t now_nanos);

  std::uint32_t counter() const { return sample_.counter; }
  std::uint32_t time_code_millis() const {
    return static_cast<std::uint32_t>(sample_.time_code_millis);
  }
  const Arrival& first_arrival() const { return first_arrival_; }
  std::uint64_t datagrams() const { return datagrams_; }
  SampleTypes begun() const;                                 // at least one part received
  SampleTypes whole() const;                                 // all parts received
  const SampleDigests& digests() const { return digests_; }  // of the first part of each type
  int mismatched_ids() const { return mismatched_ids_; }

  bool HasPose() const;     // all 23 segments: 02, or 21 and 22, or 01
  bool HasObjects() const;  // a complete 02 of a few segments that are not a body

  /// The sample with the values so far, without stamp and character. @pre HasPose()
  BodySample TakeBody() const;
  /// The sample with the values so far, without stamp and character. @pre HasObjects()
  ObjectsSample TakeObjects() const;

 private:
  struct Parts {
    std::bitset<128> came;
    int last = -1;  // number of the last part; -1: unknown
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
  void Store(const Other&) {}  // markers: checked only, since the poses contain the same
                               // information

  using Slots = std::bitset<kSlotCount>;
  static bool IsBody(const Slots& slots);
  bool IsWhole(SampleType type) const { return parts_[static_cast<std::size_t>(type)].whole(); }

  std::array<Parts, kSampleTypeCount> parts_;
  SampleDigests digests_{};
  std::uint64_t datagrams_ = 0;
  int body_segments_ = 0;  // according to the header of 02
  int mismatched_ids_ = 0;
  Arrival first_arrival_;
  BodySample sample_;  // everything except the poses
  Slots posed_, euler_posed_, linear_, angular_;
  std::array<urdf::Pose, kSlotCount> poses_{};          // of 02
  std::array<urdf::Pose, kSlotCount> euler_poses_{};    // of 01
  std::array<urdf::Pose, kSlotCount> derived_poses_{};  // positions of 21, orientations of 22
  std::array<Eigen::Vector3d, urdf::kJointCount> angles_{};
  std::bitset<urdf::kJointCount> angled_;
};

}  // namespace kinescope::mvn
