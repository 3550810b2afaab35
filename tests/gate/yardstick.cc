// The yardstick of tests/budget.json: compiling this costs what it costs on this machine at this
// moment, and prices are counted in it. It stays as it is: a change of it changes every price.
#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <unordered_map>
#include <vector>

namespace yardstick {

template <int kNumber>
std::string Words(const std::map<std::string, std::vector<std::set<int>>>& in) {
  std::unordered_map<std::string, std::function<int(int)>> turns;
  std::ostringstream out;
  for (const auto& entry : in) {
    const auto& sets = entry.second;
    turns[entry.first] = [&sets](int i) { return static_cast<int>(sets.size()) * i + kNumber; };
    std::vector<int> numbers;
    for (const auto& set : sets) numbers.insert(numbers.end(), set.begin(), set.end());
    std::sort(numbers.begin(), numbers.end(),
              [](int a, int b) { return a % kNumber < b % kNumber; });
    for (const int number : numbers) out << turns[entry.first](number) << ' ';
  }
  return out.str();
}

std::string All(const std::map<std::string, std::vector<std::set<int>>>& in) {
  return Words<2>(in) + Words<3>(in) + Words<5>(in) + Words<7>(in);
}

}  // namespace yardstick
