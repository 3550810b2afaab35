/// What is accepted of the cases of a folder: its file `golden.lock`, JSON with one line per fact.
/// It says what each picture shows, and what it was drawn from and with, so that a changed
/// recording is told apart from a changed program, and a picture need not be there to be compared.
/// Pure but for files; one thread.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "render/image/image.h"
#include "render/renderer.h"
#include "server/app/golden/picture_facts.h"

namespace kinescope::app {

/// A file that a case reads; its content decides what is drawn.
struct InputFact {
  std::string option;  // "source", "wrenches", ...
  std::string name;    // without its folder; "demo:lift"
  std::string sha256;  // "": generated motion or a written pose, which the program makes

  bool operator==(const InputFact& other) const {
    return option == other.option && name == other.name && sha256 == other.sha256;
  }
};

/// A picture with all that is known of it.
struct AcceptedCase {
  std::string pixels_sha256;    // of size and pixels, however the file is compressed
  std::string unmasked_sha256;  // of what no mask covers; "": there are no masks
  std::string file_sha256;      // of the PNG file: also what a pointer of Git LFS names
  int width = 0, height = 0;    // px
  std::map<std::string, nlohmann::json> options;  // of the case, those that it sets
  std::vector<InputFact> inputs;
  std::map<std::string, std::string> environment;  // what else decides pixels: "renderer", "font"
  PictureFacts facts;
};

/// By the names of their cases.
using GoldenLock = std::map<std::string, AcceptedCase>;

/// SHA-256 of size and pixels. @pre the picture is complete
std::string PixelsHash(const render::Image& image);

/// Back-end, driver, font: what pictures depend on besides program, case and inputs.
std::map<std::string, std::string> EnvironmentOf(const render::RendererInfo& renderer);

/// The content of `golden.lock`. @throws std::exception with the reason.
/// @param pictures  is set to the folder of the pictures, relative to that of the cases; "": there
GoldenLock ParseLock(const std::string& text, std::string* pictures = nullptr);
/// A file of JSON, of at most 256 MiB. @throws std::runtime_error with the reason alone.
std::string ReadSmallFile(const std::filesystem::path& path);

/// Empty if there is no such file. @throws std::runtime_error with file and reason.
GoldenLock ReadLock(const std::filesystem::path& path, std::string* pictures = nullptr);
/// @throws std::runtime_error with file and reason.
void WriteLock(const std::filesystem::path& path, const GoldenLock& lock,
               const std::string& pictures = "");

std::string ToJson(const AcceptedCase& accepted);
/// @throws nlohmann::json::exception if a member is missing or of another type.
AcceptedCase AcceptedFrom(const nlohmann::json& json);

}  // namespace kinescope::app
