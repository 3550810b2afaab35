/// Copies vertices into VTK's arrays.
#pragma once

#include <vtkFloatArray.h>
#include <vtkNew.h>

#include <algorithm>
#include <vector>

namespace kinescope::render {

/// Into memory that the array already has, where it is enough. `T`: `components` floats.
template <class T>
void CopyInto(vtkFloatArray* array, int components, const std::vector<T>& values) {
  static_assert(sizeof(T) % sizeof(float) == 0);
  const auto* from = reinterpret_cast<const float*>(values.data());
  const auto count = static_cast<vtkIdType>(values.size()) * components;
  array->SetNumberOfComponents(components);
  std::copy(from, from + count, array->WritePointer(0, count));
  array->Modified();
}

template <class T>
vtkNew<vtkFloatArray> ToFloatArray(const char* name, int components, const std::vector<T>& values) {
  vtkNew<vtkFloatArray> array;
  array->SetName(name);
  CopyInto(array, components, values);
  return array;
}

}  // namespace kinescope::render
