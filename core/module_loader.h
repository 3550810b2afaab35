/// Shared libraries that are loaded when they are first needed. Host and module exchange C++
/// values, so both must come from the same build; LoadModule refuses anything else.
#pragma once

#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace kinescope {

/// The message names the file, the reason and what would help.
class ModuleError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Raised by hand when host and module of different builds would not understand each other and no
/// size tells: virtual functions, an order of members, a meaning.
inline constexpr std::size_t kModuleAbi = 5;

/// What must be equal on both sides; a changed struct changes a size here in nearly every case.
/// `Types`: all that the functions of a table take and give, and what is behind pointers and in
/// containers there. tests/module_abi_test.py finds one that is missing.
template <class... Types>
struct ModuleAbi {
  std::array<std::size_t, 2 + sizeof...(Types)> words = {kModuleAbi, sizeof...(Types),
                                                         sizeof(Types)...};
};

/// The table that `entry` of a module returns; the module stays loaded until the process ends.
/// `abi`: the words that the table has to begin with. @throws ModuleError.
const void* LoadModule(const std::string& file_name, const char* entry, const std::size_t* abi,
                       std::size_t abi_words);

template <class Module>
const Module& LoadModule(const std::string& file_name, const char* entry) {
  const decltype(Module::abi) ours{};
  return *static_cast<const Module*>(
      LoadModule(file_name, entry, ours.words.data(), ours.words.size()));
}

}  // namespace kinescope
