/// Loads shared libraries when they are first needed. Host and module exchange C++ values, so both
/// must come from the same build; OpenModule rejects other modules. Any thread.
#pragma once

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace kinescope {

/// The message contains the file, the reason and the remedy.
class ModuleError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Increase it by hand when host and module of different builds are incompatible although no size
/// changed: virtual functions, order of members, meaning of a value.
inline constexpr std::size_t kModuleAbi = 6;

/// Values that must be equal on both sides; a changed struct changes a size here in nearly every
/// case. `Types`: all types that the functions of a table take and return, and the types behind
/// their pointers and in their containers. tests/module_abi_test.py finds a missing one.
template <class... Types>
struct ModuleAbi {
  std::array<std::size_t, 2 + sizeof...(Types)> words = {kModuleAbi, sizeof...(Types),
                                                         sizeof(Types)...};
};

/// Returns the table that `entry` of a module returns. The module stays loaded until the process
/// ends. `abi`: the words that the table must begin with. @throws ModuleError.
const void* OpenModule(const std::string& file_name, const char* entry, const std::size_t* abi,
                       std::size_t abi_words);

template <class Module>
const Module& OpenModule(const std::string& file_name, const char* entry) {
  const decltype(Module::abi) ours{};
  return *static_cast<const Module*>(
      OpenModule(file_name, entry, ours.words.data(), ours.words.size()));
}

}  // namespace kinescope
