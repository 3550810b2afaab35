#include "render/vtk/log_window.h"

#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace kinescope::render {
namespace {

thread_local const LogLine* current_log = nullptr;

// Lines and runs of blanks become one blank; VTK's text starts with the place in its source.
std::string OneLine(const char* text) {
  std::string line;
  for (const char* c = text; *c != '\0'; ++c) {
    const bool is_blank = *c == '\n' || *c == '\r' || *c == '\t' || *c == ' ';
    if (!is_blank) line += *c;
    if (is_blank && !line.empty() && line.back() != ' ') line += ' ';
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

class LineWindow : public vtkOutputWindow {
 public:
  static LineWindow* New();

  void DisplayText(const char* text) override {
    if (text == nullptr) return;
    const std::string line = "vtk: " + OneLine(text);
    if (current_log != nullptr) {
      (*current_log)(line);
    } else {
      std::fprintf(stderr, "render: %s\n", line.c_str());
    }
  }
  void DisplayErrorText(const char* text) override { DisplayText(text); }
  void DisplayWarningText(const char* text) override { DisplayText(text); }
  void DisplayGenericWarningText(const char* text) override { DisplayText(text); }
  void DisplayDebugText(const char* text) override { DisplayText(text); }
};

vtkStandardNewMacro(LineWindow)

}  // namespace

VtkLogScope::VtkLogScope(const LogLine& log) : outer_(current_log) {
  static const bool installed = [] {
    vtkOutputWindow::SetInstance(vtkSmartPointer<LineWindow>::New());
    return true;
  }();
  static_cast<void>(installed);
  current_log = &log;
}

VtkLogScope::~VtkLogScope() { current_log = outer_; }

}  // namespace kinescope::render
