/// Keeps the pixels of floors that are drawn again and again: those of the views and tiles of one
/// picture, while their cameras stand still. Knows no GL. One thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "render/image/image.h"
#include "render/image/tile.h"

namespace kinescope::render {

class FloorCache {
 public:
  /// All values that the floor's pixels depend on.
  using Key = std::array<double, 32>;

  /// A floor that is not asked for in this many calls of Find() is forgotten: more than one picture
  /// has tiles and views, so that all of a picture are kept, and those of former cameras go.
  static constexpr std::uint64_t kLongest = 64;
  /// Enough for the floor of a picture of 4096 x 4096 px.
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20;

  /// `most_bytes`: of all floors that are kept.
  explicit FloorCache(std::size_t most_bytes = kMostBytes) : most_bytes_(most_bytes) {}

  /// The floor of `key`, the pixels of its tile; or null. Call it once for each tile that is drawn.
  SharedPixels Find(const Key& key);

  /// What Find() did not find has been drawn into `tile` of `image`. It is kept from its second
  /// time on, because a camera that moves should not pay for copies. Where there is no room, it
  /// takes the place of floors that nothing asked for between its two times: floors of one picture
  /// that is too large do not drive each other out. @return what is kept, or null
  SharedPixels Keep(const Key& key, const Tile& tile, const Image& image);

  std::size_t bytes() const { return bytes_; }

 private:
  struct Entry {
    Key key{};
    std::uint64_t used = 0, used_before = 0;  // calls of Find(); 0: never
    SharedPixels rgba;                        // null: not kept
  };
  void ForgetOld();
  bool MakeRoom(std::size_t bytes, std::uint64_t since);
  void Drop(Entry& entry);

  const std::size_t most_bytes_;
  std::vector<Entry> entries_;  // few: each was asked for in the last kLongest calls
  std::uint64_t now_ = 0;       // calls of Find()
  std::size_t bytes_ = 0;
};

/// Copies `part` of the floor of `tile` into `image`. px of the picture; `part` is inside of
/// `tile`.
void CopyFloor(const std::vector<std::uint8_t>& floor, const Tile& tile, const Tile& part,
               Image& image);

}  // namespace kinescope::render
