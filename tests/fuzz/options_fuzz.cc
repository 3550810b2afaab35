// `name=text`: any text as the value of an option of that name, in every command that has one. It
// is rejected with a reason, or it is a value whose own text means the same again.
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/system/check.h"
#include "core/system/words.h"
#include "server/options/value.h"
#include "tests/server/app/all_commands.h"

namespace options_fuzz {
namespace {

using namespace kinescope;
using options::Value;

void AddValues(std::vector<app::Command>& commands,
               std::map<std::string, std::vector<Value*>>& values) {
  for (app::Command& command : commands) {
    for (const options::Option& option : command.options) {
      values[option.name].push_back(option.value);
    }
    AddValues(command.parts, values);
  }
}

const std::map<std::string, std::vector<Value*>>& ValuesByName() {
  static std::vector<app::Command> commands = testing::AllCommands();
  static const auto by_name = [] {
    std::map<std::string, std::vector<Value*>> values;
    AddValues(commands, values);
    return values;
  }();
  return by_name;
}

void CheckValue(Value& value, const std::string& text) {
  try {
    value.Parse(text);
  } catch (const options::BadValue& reason) {
    KINESCOPE_CHECK(reason.what()[0] != '\0');
    SuggestionFor(text, value.Names());
    return;
  }
  const std::string own = value.ToText();
  value.Parse(own);
  KINESCOPE_CHECK(value.ToText() == own);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string input(reinterpret_cast<const char*>(data), size);
  const std::size_t sign = input.find('=');
  const auto found = ValuesByName().find(input.substr(0, sign));
  if (sign == std::string::npos || found == ValuesByName().end()) return -1;  // not for the corpus
  for (Value* const value : found->second) CheckValue(*value, input.substr(sign + 1));
  return 0;
}

}  // namespace options_fuzz
