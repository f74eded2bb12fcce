// The trunnion under any control.
#pragma once

#include "tests/postproc/readback/nc_case.h"

namespace toothpath::test {

/// The trunnion under this control; LinuxCNC's TCP codes are site data, and so is the offset that it may turn with TCP.
inline machines::Machine trunnion_with(const std::string& dialect, machines::TcpMode tcp) {
  machines::Machine m = with_dialect(trunnion(), dialect);
  m.tcp = tcp;
  if (dialect == "linuxcnc") {
    m.post.tcp_on = {"M428"};
    m.post.tcp_off = {"M429"};
    m.post.index_offset = "G59.3";
  }
  return m;
}

}  // namespace toothpath::test
