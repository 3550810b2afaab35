/// A mesh file that appears when a reader asks for it. Any thread.
#pragma once

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>

#include "core/mesh_files.h"

namespace kinescope::testing {

class MeshFileOnDemand : public MeshFiles {
 public:
  MeshFileOnDemand(std::filesystem::path path, std::string content)
      : path_(std::move(path)), content_(std::move(content)) {}

  bool Provide() const override {
    std::ofstream(path_, std::ios::binary) << content_;
    is_provided_ = true;
    return true;
  }
  bool is_provided() const { return is_provided_; }

 private:
  const std::filesystem::path path_;
  const std::string content_;
  mutable std::atomic<bool> is_provided_{false};
};

}  // namespace kinescope::testing
