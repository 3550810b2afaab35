#include "server/mvn/giving_way.h"

#include <algorithm>
#include <tuple>

namespace kinescope::mvn {
namespace {

constexpr std::ptrdiff_t kPeopleOfOneMvn = 4;

}  // namespace

std::optional<std::size_t> WhoGivesWay(const std::vector<PlaceHolder>& holders,
                                       const Endpoint& newcomer, bool newcomer_has_body) {
  const auto of_machine = [&](const Endpoint& sender) {
    return std::count_if(holders.begin(), holders.end(), [&](const PlaceHolder& holder) {
      return holder.sender.address == sender.address;
    });
  };
  const auto of_port = [&](const Endpoint& sender) {
    return std::count_if(holders.begin(), holders.end(),
                         [&](const PlaceHolder& holder) { return holder.sender == sender; });
  };
  const auto may_be_displaced = [&](const PlaceHolder& holder) {
    if (holder.sender == newcomer) return newcomer_has_body && !holder.has_body;
    const bool is_same_machine = holder.sender.address == newcomer.address;
    const auto theirs = is_same_machine ? of_port(holder.sender) : of_machine(holder.sender);
    const auto own = is_same_machine ? of_port(newcomer) : of_machine(newcomer);
    if (holder.has_body) {
      return newcomer_has_body && theirs > kPeopleOfOneMvn && theirs >= own + 2;
    }
    return theirs >= own + (newcomer_has_body ? 1 : 2);
  };
  // The smallest goes: without a body before the others, of the most crowded machine and port. Of
  // those with a body the newest, of the others the oldest, which has had the longest time.
  const auto rank = [&](const PlaceHolder& holder) {
    return std::make_tuple(!may_be_displaced(holder), holder.has_body, -of_machine(holder.sender),
                           -of_port(holder.sender), holder.is_confirmed,
                           holder.has_body ? -holder.since_nanos : holder.since_nanos);
  };
  const auto first = std::min_element(
      holders.begin(), holders.end(),
      [&](const PlaceHolder& a, const PlaceHolder& b) { return rank(a) < rank(b); });
  if (first == holders.end() || !may_be_displaced(*first)) return std::nullopt;
  return static_cast<std::size_t>(first - holders.begin());
}

}  // namespace kinescope::mvn
