// Mutator for each fuzz target. Half of the mutations are libFuzzer's own.
#pragma once

#include <algorithm>
#include <cstring>
#include <string>

#include "tests/fuzz/grammar.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t longest);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t longest,
                                               unsigned seed) {
  if (seed % 2 == 0) return LLVMFuzzerMutate(data, size, longest);
  const std::string job = axisgate::rml1::mutated(std::string(data, data + size), longest, seed);
  std::memcpy(data, job.data(), job.size());
  return job.size();
}
