// LinuxCNC's kinematics modules as they are shipped, loaded at run time: xyzac-trt-kins and xyzbc-trt-kins of the
// Debian package. Nothing of LinuxCNC is needed to build this. The test program must export its symbols
// (ENABLE_EXPORTS): the modules call the HAL functions that linuxcnc_kinematics.cpp supplies.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "geometry/base/result.h"
#include "geometry/base/vec.h"

namespace toothpath::test {

/// Folder of the modules: TOOTHPATH_LINUXCNC_MODULES, or what tools/get_rs274.sh fetched.
std::string linuxcnc_module_folder();

/// One loaded module. Angles in rad at this interface, degrees inside the module; lengths mm.
class LinuxcncModule {
 public:
  /// @param name "xyzac-trt-kins" or "xyzbc-trt-kins". Errors: no such file, a symbol is missing, the module refuses to
  /// start.
  static Result<std::unique_ptr<LinuxcncModule>> load(const std::string& name);
  ~LinuxcncModule();
  LinuxcncModule(const LinuxcncModule&) = delete;
  LinuxcncModule& operator=(const LinuxcncModule&) = delete;

  /// Value of a pin, named without the module: "x-rot-point", "y-offset", "tool-offset". A name that is no pin is an
  /// error.
  [[nodiscard]] Status set(const std::string& pin, double value);
  /// Names of all float pins, for messages.
  [[nodiscard]] std::string pins() const;

  struct Values {
    Vec3 xyz = Vec3::Zero();
    double tilt_rad = 0.0;  ///< A or B
    double c_rad = 0.0;
  };
  /// Pose of these joints as LinuxCNC reports it: the tool offset is still in its z.
  [[nodiscard]] Result<Values> forward(const Values& joints) const;
  /// Joints of a pose as LinuxCNC reports it.
  [[nodiscard]] Result<Values> inverse(const Values& pose) const;

 private:
  LinuxcncModule() = default;
  void* handle_ = nullptr;
  char tilt_ = 'A';
  std::string name_;
  std::map<std::string, double*> pins_;
};

}  // namespace toothpath::test
