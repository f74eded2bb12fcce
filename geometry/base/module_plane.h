// The plane in which a module and what counts in modules are given.
#pragma once

namespace toothpath {

enum class ModulePlane { normal, transverse };

}  // namespace toothpath
