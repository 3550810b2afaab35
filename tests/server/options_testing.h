/// Options set by name, as users set them.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "core/system/errors.h"
#include "server/options/option_list.h"

namespace kinescope::testing {

using Settings = std::vector<std::pair<std::string, std::string>>;  // name, text

/// Sets options of `values`, which has a List(). @throws UsageError as the command line does.
template <class Values>
void Set(Values& values, const Settings& settings) {
  options::OptionList list;
  values.List(list);
  for (const auto& [name, text] : settings) {
    options::Option* const option = list.Find(name);
    ASSERT_NE(option, nullptr) << name;
    list.Set(*option, name, {text}, options::Channel::kCommandLine);
  }
}

/// Those of `Values` with some set.
template <class Values>
Values With(const Settings& settings) {
  Values values;
  Set(values, settings);
  return values;
}

/// The error of setting one; "" where it is accepted.
template <class Values>
std::string ErrorOfSetting(const std::string& name, const std::string& text) {
  Values values;
  try {
    Set(values, {{name, text}});
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

}  // namespace kinescope::testing
