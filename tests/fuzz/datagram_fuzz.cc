// Any bytes as one datagram: refused with a place inside it, or accepted and written again as a
// datagram that means the same.
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <variant>

#include "server/core/check.h"
#include "server/mvn/encode.h"

namespace {

using namespace kinescope::mvn;

// The same body as `again`, apart from what the encoder does not write (skipped items).
void CheckSameShape(const Message& message, const Message& again) {
  KINESCOPE_CHECK(message.body.index() == again.body.index());
  KINESCOPE_CHECK(message.header.sample_counter == again.header.sample_counter);
  KINESCOPE_CHECK(message.header.part == again.header.part);
  KINESCOPE_CHECK(message.header.character == again.header.character);
  if (const auto* pose = std::get_if<PoseMessage>(&message.body)) {
    KINESCOPE_CHECK(pose->present == std::get<PoseMessage>(again.body).present);
    for (std::size_t i = 0; i < pose->items.size(); ++i) {
      if (!pose->present.test(i)) continue;
      const PoseItem& item = std::get<PoseMessage>(again.body).items[i];
      KINESCOPE_CHECK(item.position == pose->items[i].position);
      KINESCOPE_CHECK(item.orientation.angularDistance(pose->items[i].orientation) < 1e-5);
    }
  }
  if (const auto* scale = std::get_if<ScaleMessage>(&message.body)) {
    const auto& other = std::get<ScaleMessage>(again.body);
    KINESCOPE_CHECK(scale->segments.size() == other.segments.size());
    KINESCOPE_CHECK(scale->points.size() == other.points.size());
  }
  if (const auto* meta = std::get_if<MetaDataMessage>(&message.body)) {
    KINESCOPE_CHECK(meta->name == std::get<MetaDataMessage>(again.body).name);
    KINESCOPE_CHECK(meta->color_rgb == std::get<MetaDataMessage>(again.body).color_rgb);
  }
}

// Items that were skipped are not written; a message of nothing else would be refused.
bool HasContent(const Message& message) {
  struct Visitor {
    bool operator()(const NotNeeded&) const { return false; }
    bool operator()(const PoseMessage& body) const { return body.present.any(); }
    bool operator()(const LinearMessage& body) const { return body.present.any(); }
    bool operator()(const AngularMessage& body) const { return body.present.any(); }
    bool operator()(const JointAnglesMessage& body) const {
      // Vertical_T8 alone would come back as its twin.
      return body.joints_present.any() && body.ergonomic_present.none();
    }
    bool operator()(const CenterOfMassMessage&) const { return true; }
    bool operator()(const MetaDataMessage&) const { return true; }
    bool operator()(const ScaleMessage&) const { return true; }
  };
  return std::visit(Visitor(), message.body);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > kLargestDatagram) return 0;  // no network can deliver it
  const auto message = ParseDatagram({reinterpret_cast<const char*>(data), size});
  if (!message) {
    KINESCOPE_CHECK(message.error().offset <= size);
    KINESCOPE_CHECK(!Describe(message.error()).empty());
    return 0;
  }
  if (!HasContent(*message)) return 0;
  const auto again = ParseDatagram(Encode(*message));
  KINESCOPE_CHECK(again.has_value());
  CheckSameShape(*message, *again);
  return 0;
}
