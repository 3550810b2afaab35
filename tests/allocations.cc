#include "tests/allocations.h"

#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>

namespace {

constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();

std::atomic<std::size_t> allocations{0};
std::atomic<std::size_t> fails_from_bytes{kNever};
thread_local bool is_spared = false;

void OnAllocation(std::size_t size) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  std::size_t from = fails_from_bytes.load();
  if (size < from || is_spared) return;
  if (fails_from_bytes.compare_exchange_strong(from, kNever)) throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) {
  OnAllocation(size);
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  OnAllocation(size);
  const auto to = static_cast<std::size_t>(alignment);
  if (void* const memory = std::aligned_alloc(to, (size + to - 1) / to * to)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

std::size_t kinescope::testing::Allocations() { return allocations.load(); }

void kinescope::testing::FailNextAllocationElsewhere(std::size_t bytes) {
  is_spared = true;
  fails_from_bytes = bytes;
}
