// The trunnion under any control.
#pragma once

#include "tests/postproc/nc_case.h"

namespace toothpath::test {

/// The trunnion under this control; LinuxCNC's TCP codes are site data.
inline Machine trunnion_with(const std::string& dialect, TcpMode tcp) {
  Machine m = with_dialect(trunnion(), dialect);
  m.tcp = tcp;
  if (dialect == "linuxcnc") {
    m.post.tcp_on = {"M428"};
    m.post.tcp_off = {"M429"};
  }
  return m;
}

}  // namespace toothpath::test
