#include "tests/postproc/joints/linuxcnc_kinematics.h"

#include <dlfcn.h>

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <vector>

#include "geometry/base/angle.h"

namespace {

// What the modules take from HAL, kept in ordinary memory. Addresses in a deque stay where they are.
struct Hal {
  std::map<std::string, double*> floats;
  std::deque<double> float_values;
  std::deque<int> whole_values;
  std::deque<std::vector<char>> blocks;
  std::string said;
};
Hal& hal() {
  static Hal all;
  return all;
}

// LinuxCNC's EmcPose: nine doubles in this order.
struct Pose {
  double x, y, z, a, b, c, u, v, w;
};
constexpr int kMostJoints = 16;

void* symbol(void* handle, const char* name) { return dlsym(handle, name); }

}  // namespace

// The names and signatures are LinuxCNC's (hal.h, rtapi.h); 0 is success. A pin is a cell that the module points at.
extern "C" {
int hal_init(const char*) { return 1; }
int hal_exit(int) { return 0; }
int hal_ready(int) { return 0; }
void* hal_malloc(long bytes) { return hal().blocks.emplace_back(static_cast<std::size_t>(bytes)).data(); }
int hal_pin_bit_new(const char*, int, volatile bool** cell, int) {
  *cell = reinterpret_cast<volatile bool*>(&hal().whole_values.emplace_back(0));
  return 0;
}
int hal_pin_s32_new(const char*, int, volatile int** cell, int) {
  *cell = &hal().whole_values.emplace_back(0);
  return 0;
}
__attribute__((format(printf, 4, 5))) int hal_pin_float_newf(int, volatile double** cell, int, const char* format,
                                                             ...) {
  char name[200];
  va_list values;
  va_start(values, format);
  std::vsnprintf(name, sizeof name, format, values);
  va_end(values);
  double& value = hal().float_values.emplace_back(0.0);
  hal().floats[name] = &value;
  *cell = &value;
  return 0;
}
__attribute__((format(printf, 1, 2))) void rtapi_print(const char* format, ...) { hal().said += format; }
__attribute__((format(printf, 2, 3))) void rtapi_print_msg(int, const char* format, ...) { hal().said += format; }
}

namespace toothpath::test {

std::string linuxcnc_module_folder() {
  if (const char* given = std::getenv("TOOTHPATH_LINUXCNC_MODULES")) return given;
  return std::string(TOOTHPATH_SOURCE_DIR) + "/.deps/rs274/modules";
}

Result<std::unique_ptr<LinuxcncModule>> LinuxcncModule::load(const std::string& name) {
  const std::string file = linuxcnc_module_folder() + "/" + name + ".so";
  if (!std::filesystem::exists(file)) return fail("{} is missing: run tools/get_rs274.sh", file);
  std::unique_ptr<LinuxcncModule> module(new LinuxcncModule);
  module->name_ = name;
  module->tilt_ = name.find("ac") != std::string::npos ? 'A' : 'B';
  hal().floats.clear();
  hal().said.clear();
  module->handle_ = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!module->handle_) return fail("{} cannot be loaded: {}", file, dlerror());
  for (const char* needed : {"rtapi_app_main", "rtapi_app_exit", "kinematicsForward", "kinematicsInverse"})
    if (!symbol(module->handle_, needed)) return fail("{} has no {}", file, needed);
  const int started = reinterpret_cast<int (*)()>(symbol(module->handle_, "rtapi_app_main"))();
  if (started != 0) return fail("{} refuses to start ({}): {}", file, started, hal().said);
  for (const auto& [pin, value] : hal().floats) module->pins_[pin.substr(pin.find('.') + 1)] = value;
  return module;
}

LinuxcncModule::~LinuxcncModule() {
  if (!handle_) return;
  if (void* end = symbol(handle_, "rtapi_app_exit")) reinterpret_cast<void (*)()>(end)();
  dlclose(handle_);
}

Status LinuxcncModule::set(const std::string& pin, double value) {
  const auto found = pins_.find(pin);
  if (found == pins_.end()) return fail("{} has no pin {}; it has {}", name_, pin, pins());
  *found->second = value;
  return Ok{};
}

std::string LinuxcncModule::pins() const {
  std::string all;
  for (const auto& [pin, value] : pins_) all += (all.empty() ? "" : ", ") + pin;
  return all;
}

Result<LinuxcncModule::Values> LinuxcncModule::forward(const Values& joints) const {
  // Both modules number their joints X Y Z tilt C.
  const double positions[kMostJoints] = {joints.xyz.x(), joints.xyz.y(), joints.xyz.z(), degrees(joints.tilt_rad),
                                         degrees(joints.c_rad)};
  Pose pose{};
  const unsigned long flags = 0;
  unsigned long back = 0;
  using Forward = int (*)(const double*, Pose*, const unsigned long*, unsigned long*);
  if (const int r = reinterpret_cast<Forward>(symbol(handle_, "kinematicsForward"))(positions, &pose, &flags, &back);
      r != 0)
    return fail("kinematicsForward of {} returns {}", name_, r);
  return Values{{pose.x, pose.y, pose.z}, radians(tilt_ == 'A' ? pose.a : pose.b), radians(pose.c)};
}

Result<LinuxcncModule::Values> LinuxcncModule::inverse(const Values& pose) const {
  Pose world{pose.xyz.x(), pose.xyz.y(), pose.xyz.z(), 0, 0, degrees(pose.c_rad), 0, 0, 0};
  (tilt_ == 'A' ? world.a : world.b) = degrees(pose.tilt_rad);
  double positions[kMostJoints] = {};
  const unsigned long flags = 0;
  unsigned long back = 0;
  using Inverse = int (*)(const Pose*, double*, const unsigned long*, unsigned long*);
  if (const int r = reinterpret_cast<Inverse>(symbol(handle_, "kinematicsInverse"))(&world, positions, &flags, &back);
      r != 0)
    return fail("kinematicsInverse of {} returns {}", name_, r);
  return Values{{positions[0], positions[1], positions[2]}, radians(positions[3]), radians(positions[4])};
}

}  // namespace toothpath::test
