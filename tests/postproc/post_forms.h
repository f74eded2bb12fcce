// Every form in which a program can hold its teeth: dialect, with or without TCP, loop, calls, or written out.
#pragma once

#include "postproc/tooth_order.h"
#include "tests/postproc/nc_case.h"

namespace toothpath::test {

struct PostForm {
  const char* dialect;
  TcpMode tcp;
  double swing;  ///< turn of the tool axis inside a pass
  bool expand;   ///< every tooth written out
};

inline void PrintTo(const PostForm& f, std::ostream* out) {
  *out << f.dialect << (f.tcp == TcpMode::none ? "" : f.tcp == TcpMode::angles ? "_tcp" : "_vectors") << (f.expand ? "_written" : "");
}

inline const std::vector<PostForm>& post_forms() {
  static const std::vector<PostForm> forms = {
      {"linuxcnc", TcpMode::none, 0.1, false},     {"linuxcnc", TcpMode::none, 0.1, true},      {"linuxcnc", TcpMode::angles, 0.1, true},
      {"fanuc", TcpMode::none, 0, false},          {"fanuc", TcpMode::none, 0.1, true},         {"fanuc", TcpMode::angles, 0.1, true},
      {"mitsubishi_m80", TcpMode::none, 0, false}, {"siemens", TcpMode::none, 0.1, false},      {"siemens", TcpMode::angles, 0.1, false},
      {"siemens", TcpMode::vectors, 0.1, false},   {"siemens", TcpMode::vectors, 0.1, true},    {"heidenhain", TcpMode::none, 0, false},
      {"heidenhain", TcpMode::angles, 0, false},   {"heidenhain", TcpMode::vectors, 0.1, true}, {"apt", TcpMode::vectors, 0.1, true}};
  return forms;
}

inline Machine machine_of(const PostForm& f) {
  Machine m = with_dialect(trunnion(), f.dialect);
  m.tcp = f.tcp;
  if (std::string(f.dialect) == "linuxcnc") {
    m.post.tcp_on = {"M428"};
    m.post.tcp_off = {"M429"};
  }
  return m;
}

inline Result<AxisProgram> program_of(const PostForm& f, const std::vector<ClPath>& paths, int teeth, int stride) {
  const Machine m = machine_of(f);
  auto dialect = dialect_of(m);
  if (!dialect) return dialect.error();
  AxisOptions o = axis_options(*dialect, m);
  o.expand_teeth = f.expand;
  o.tooth_stride = stride;
  return AxisProgramTestAccess::build(paths, tools(), standing(), m, teeth, kBody, o);
}

inline Result<NcText> text_of(const PostForm& f, const AxisProgram& program) {
  NcHeader header;
  header.job_name = "sample";
  header.machine_name = "trunnion";
  header.coolant = true;
  return write_nc(program, *dialect_of(machine_of(f)), header);
}

}  // namespace toothpath::test
