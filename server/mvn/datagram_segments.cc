// Parses the messages that are rows of numbers per segment: 01, 02, 21, 22.
#include <algorithm>

#include "server/mvn/item_reader.h"

namespace kinescope::mvn {
namespace {

constexpr double kRadPerDeg = 3.14159265358979323846 / 180;

struct EulerItem : PoseItem {};

bool ReadItem(ItemReader& in, PoseItem& item) {
  return in.ReadVector(item.position) && in.ReadUnitQuaternion(item.orientation);
}

// The stream rotates about fixed x, then y, then z; its axes (x, y, z) are (y, z, x) of the Z-up
// world (mvn-protocol.md 2, type 01).
bool ReadItem(ItemReader& in, EulerItem& item) {
  Eigen::Vector3d centimetres;
  Eigen::Vector3d degrees;
  if (!in.ReadVector(centimetres) || !in.ReadVector(degrees)) return false;
  item.position = FromYUp(centimetres) * kMetresPerCentimetre;
  const auto turn = [](double deg, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(deg * kRadPerDeg, axis);
  };
  item.orientation = turn(degrees.z(), Eigen::Vector3d::UnitX()) *
                     turn(degrees.y(), Eigen::Vector3d::UnitZ()) *
                     turn(degrees.x(), Eigen::Vector3d::UnitY());
  return true;
}

bool ReadItem(ItemReader& in, LinearItem& item) {
  return in.ReadVector(item.position) && in.ReadVector(item.velocity) &&
         in.ReadVector(item.acceleration);
}

bool ReadItem(ItemReader& in, AngularItem& item) {
  return in.ReadUnitQuaternion(item.orientation) && in.ReadVector(item.velocity) &&
         in.ReadVector(item.acceleration);
}

// Finds the slot of each item. Ids of fingers follow those of the props (mvn-protocol.md 4.2). The
// vendor's own plugin ignores them and uses the order, so the order takes precedence if the
// datagram contains everything that its header announces.
class SlotFinder {
 public:
  SlotFinder(const Header& header, int item_count)
      : props_(header.body_segments == 0 ? kMaxProps : header.props),  // absent in old headers
        fingers_(header.finger_segments),
        goes_by_order_(header.body_segments == urdf::kSegmentCount && header.part == 0 &&
                       header.is_last_part &&
                       item_count == urdf::kSegmentCount + header.props + header.finger_segments) {}

  struct Slot {
    int index = -1;  // -1: unknown
    bool is_mismatched = false;
  };

  Slot Find(std::uint32_t id, int place) const {
    const auto wanted = static_cast<int>(std::min<std::uint32_t>(id, 1000)) - 1;
    if (goes_by_order_ && place >= urdf::kSegmentCount && wanted >= urdf::kSegmentCount) {
      return {SlotOf(place), wanted != place};
    }
    return {SlotOf(wanted), false};
  }

 private:
  // For a number that counts body, props and fingers consecutively.
  int SlotOf(int number) const {
    if (number < urdf::kSegmentCount) return number;
    const int prop = number - urdf::kSegmentCount;
    if (prop < props_) return prop < kMaxProps ? urdf::kSegmentCount + PropIndex(prop) : -1;
    const int finger = prop - props_;
    if (finger >= fingers_ || finger >= 2 * kFingersPerHand) return -1;
    const bool left = finger < kFingersPerHand;
    return urdf::kSegmentCount +
           FingerIndex(left ? urdf::kLeft : urdf::kRight, finger % kFingersPerHand);
  }

  int props_;
  int fingers_;
  bool goes_by_order_;
};

template <class WireItem, class Item>
bool Parse(ItemReader& in, const Header& header, std::size_t wire_bytes, PerSegment<Item>& out) {
  ItemLayout layout;
  if (!in.FindLayout(header, wire_bytes, layout)) return false;
  const SlotFinder finder(header, layout.count);
  for (int i = 0; i < layout.count; ++i) {
    std::uint32_t id = 0;
    WireItem item;
    // Unknown items are read as well, so that their numbers are checked.
    if (!in.GoTo(layout, i) || !in.ReadId(id) || !ReadItem(in, item)) return false;
    const auto [index, is_mismatched] = finder.Find(id, i);
    if (index < 0) {
      ++out.skipped;
      continue;
    }
    const auto slot = static_cast<std::size_t>(index);
    if (out.present.test(slot)) return in.Fail(Reason::kRepeatedId, id);
    out.present.set(slot);
    out.items[slot] = item;
    if (is_mismatched) ++out.mismatched_ids;
  }
  return true;
}

}  // namespace

bool ParseSegments(ItemReader& in, const Header& header, PoseMessage& out) {
  return Parse<PoseItem>(in, header, 32, out);
}

bool ParseSegments(ItemReader& in, const Header& header, EulerPoseMessage& out) {
  return Parse<EulerItem>(in, header, 28, out);
}

bool ParseSegments(ItemReader& in, const Header& header, LinearMessage& out) {
  return Parse<LinearItem>(in, header, 40, out);
}

bool ParseSegments(ItemReader& in, const Header& header, AngularMessage& out) {
  return Parse<AngularItem>(in, header, 44, out);
}

}  // namespace kinescope::mvn
