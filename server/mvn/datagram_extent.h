/// Finds the length of the datagram at a position in a byte stream, as far as the available bytes
/// show it. Untrusted input; pure functions, any thread.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "server/mvn/datagram.h"

namespace kinescope::mvn {

/// "MXTP" and two digits.
inline constexpr std::size_t kIdStringBytes = 6;

/// Header plus the largest payload that 16 bits can state.
inline constexpr std::size_t kLargestExtent = kHeaderBytes + 65535;

enum class Match { kNo, kPartial, kYes };

/// Whether `bytes` begin with an id string; kPartial: they end within a possible id string.
Match MatchIdString(std::string_view bytes);

/// The number in an id string. @pre MatchIdString() is kYes
int TypeNumber(std::string_view bytes);

/// Position of the first complete id string that begins at `from` or later; npos if there is none.
std::size_t FindIdString(std::string_view bytes, std::size_t from);

/// Where to continue a search from `from` that found nothing in `bytes` when more bytes have
/// arrived.
std::size_t SearchedIn(std::string_view bytes, std::size_t from);

struct Extent {
  enum class Kind {
    kSize,      // `size` bytes in total
    kNeedMore,  // all available bytes belong to it
    kOpen,      // unknown layout: the next id string ends it
    kBroken,    // contradictory content: the next id string ends it
  };
  Kind kind = Kind::kOpen;
  std::size_t size = 0;
  std::size_t short_size = 0;  // not 0: an alternative size, valid if the next id string begins
                               // there
};

/// The extent of the datagram at the start of `bytes`: as stated in its header, or for senders
/// before 2018 as derived from its type. @pre MatchIdString() is kYes
Extent ExtentOf(std::string_view bytes);

/// Position where another datagram begins within the one at the start of `bytes`, which would end
/// at `end`: this one is then corrupt. nullopt: none found so far. `searched`: where to search
/// first; updated for the next search in the same bytes and more.
/// @pre MatchIdString() is kYes
std::optional<std::size_t> FindInnerDatagram(std::string_view bytes, std::size_t end,
                                             std::size_t& searched);

}  // namespace kinescope::mvn
