/// A mesh file that is in memory, and on disk when a reader asks for the file. Any thread.
#pragma once

#include <atomic>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <utility>

#include "core/mesh_files.h"

namespace kinescope::testing {

class MeshFileOnDemand : public MeshFiles {
 public:
  MeshFileOnDemand(std::filesystem::path path, std::string content)
      : path_(std::move(path)), content_(std::make_shared<const std::string>(std::move(content))) {}

  std::shared_ptr<const std::string> Content(const std::string& name) const override {
    return name == path_.filename() ? content_ : nullptr;
  }
  bool Provide() const override {
    std::ofstream(path_, std::ios::binary) << *content_;
    is_provided_ = true;
    return true;
  }
  bool is_provided() const { return is_provided_; }

 private:
  const std::filesystem::path path_;
  const std::shared_ptr<const std::string> content_;
  mutable std::atomic<bool> is_provided_{false};
};

}  // namespace kinescope::testing
