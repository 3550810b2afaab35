/// The share of a list that one of several processes does. Values; any thread.
#pragma once

#include <string>

#include "server/options/value.h"

namespace kinescope::app {

struct Shard {
  int number = 1;  // from 1
  int count = 1;

  /// By a hash of the id alone, so that more jobs in the list move none: the first 64 bits of its
  /// SHA-256, modulo `count`, are `number` - 1.
  bool Has(const std::string& id) const;
};

/// "3/16".
class ShardValue : public options::ValueOf<Shard> {
 public:
  static constexpr int kMost = 100'000;

  ShardValue() : ValueOf({}) {}

  void Parse(const std::string& text) override;
  std::string ToText() const override;
  std::string Expected() const override;
};

}  // namespace kinescope::app
