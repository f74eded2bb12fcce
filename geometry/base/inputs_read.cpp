#include "geometry/base/inputs_read.h"

#include <algorithm>
#include <mutex>

namespace toothpath {
namespace {

std::mutex inputs_mutex;
std::vector<std::string> inputs;

}  // namespace

void note_input(const std::string& path) {
  const std::lock_guard lock(inputs_mutex);
  if (std::find(inputs.begin(), inputs.end(), path) == inputs.end()) inputs.push_back(path);
}

std::vector<std::string> inputs_read() {
  const std::lock_guard lock(inputs_mutex);
  return inputs;
}

void forget_inputs_read() {
  const std::lock_guard lock(inputs_mutex);
  inputs.clear();
}

}  // namespace toothpath
