/// How long the datagram is that begins somewhere in a stream of bytes, as far as the bytes that
/// are there can tell. Untrusted input; pure functions, any thread.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "server/mvn/datagram.h"

namespace kinescope::mvn {

/// "MXTP" and two digits.
inline constexpr std::size_t kIdStringBytes = 6;

/// Header and the largest payload that 16 bits can announce.
inline constexpr std::size_t kLargestExtent = kHeaderBytes + 65535;

enum class Match { kNo, kPartial, kYes };

/// Whether `bytes` begin with an id string; kPartial: they end within what may become one.
Match MatchIdString(std::string_view bytes);

/// The number in an id string. @pre MatchIdString() is kYes
int TypeNumber(std::string_view bytes);

/// Position of the first id string that begins at `from` or later and is there as a whole; npos.
std::size_t FindIdString(std::string_view bytes, std::size_t from);

/// `searched` for when more bytes have come than those in which nothing was found.
std::size_t SearchedIn(std::string_view bytes, std::size_t from);

struct Extent {
  enum class Kind {
    kSize,      // `size` bytes in all
    kNeedMore,  // all bytes that are there belong to it
    kOpen,      // its layout is not known: only the next id string tells
    kBroken,    // its content contradicts itself: likewise
  };
  Kind kind = Kind::kOpen;
  std::size_t size = 0;
  std::size_t short_size = 0;  // not 0: or this many, where the next id string begins there
};

/// The extent of the datagram at the start of `bytes`: what its header announces; else, for senders
/// from before 2018, what follows from its type. @pre MatchIdString() is kYes
Extent ExtentOf(std::string_view bytes);

/// Where within the datagram at the start of `bytes`, which would reach to `end`, the next one
/// begins, so that this one is damaged; nullopt: nowhere so far. `searched` is where to look first,
/// and is moved on for the next search in the same bytes and more.
/// @pre MatchIdString() is kYes
std::optional<std::size_t> FindInnerDatagram(std::string_view bytes, std::size_t end,
                                             std::size_t& searched);

}  // namespace kinescope::mvn
