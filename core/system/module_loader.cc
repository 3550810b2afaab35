#include "core/system/module_loader.h"

#include <dlfcn.h>

#include <algorithm>
#include <filesystem>

#include "core/system/install_paths.h"

namespace kinescope {

const void* OpenModule(const std::string& file_name, const char* entry, const std::size_t* abi,
                       std::size_t abi_words) {
  const std::filesystem::path path = FindModule(file_name);
  if (path.empty()) {
    throw ModuleError(file_name +
                      " was found neither beside the program nor in ../lib/kinescope; build or "
                      "install Kinescope completely");
  }
  // Local: a module's own GL must not become everybody's. Never closed: Mesa and LLVM leave threads
  // and exit handlers behind that must find their code.
  void* handle = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr && !std::filesystem::exists(path)) {
    throw ModuleError("cannot load " + path.string() +
                      ": it has not been built; build Kinescope completely (cmake --build FOLDER)");
  }
  if (handle == nullptr) {
    throw ModuleError("cannot load " + path.string() + ": " + ::dlerror() +
                      "; install the packages listed in packages.txt");
  }
  void* symbol = ::dlsym(handle, entry);
  if (symbol == nullptr)
    throw ModuleError(path.string() + " has no " + entry + "; reinstall Kinescope");
  const void* table = nullptr;
  using Entry = const void* (*)();
  table = reinterpret_cast<Entry>(symbol)();
  // Every table begins with these words. The second is how many follow, so that a table of another
  // build is not read beyond them.
  if (!std::equal(abi, abi + abi_words, static_cast<const std::size_t*>(table))) {
    throw ModuleError(
        path.string() +
        " and this program are from different builds of Kinescope; build or install both again");
  }
  return table;
}

}  // namespace kinescope
