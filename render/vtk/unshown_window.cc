#include "render/vtk/unshown_window.h"

#include <vtkObjectFactory.h>

namespace kinescope::render {

vtkStandardNewMacro(UnshownWindow);

}  // namespace kinescope::render
