// Every form in which a program can hold its teeth: dialect, with or without TCP, loop, calls, or written out.
#pragma once

#include <limits>

#include "postproc/joints/tooth_order.h"
#include "tests/postproc/joints/trunnion_post.h"

namespace toothpath::test {

struct PostForm {
  const char* dialect;
  machines::TcpMode tcp;
  double swing;          ///< turn of the tool axis inside a pass
  bool expand;           ///< every tooth written out
  int rollover = 0;      ///< C rolls over and its index rises (1) or falls (-1)
  bool granted = false;  ///< Siemens: TRAORI takes the rotary offset of the frame
};

inline void PrintTo(const PostForm& f, std::ostream* out) {
  *out << f.dialect
       << (f.tcp == machines::TcpMode::none     ? ""
           : f.tcp == machines::TcpMode::angles ? "_tcp"
                                                : "_vectors")
       << (f.granted ? "_granted" : "") << (f.expand ? "_written" : "")
       << (f.rollover > 0   ? "_rollover"
           : f.rollover < 0 ? "_rollover_back"
                            : "");
}

/// The same with a C that rolls over.
inline const std::vector<PostForm>& rollover_forms() {
  static const std::vector<PostForm> forms = [] {
    std::vector<PostForm> list;
    for (const int sense : {1, -1})
      for (const PostForm& f : {PostForm{"linuxcnc", machines::TcpMode::none, 0.1, false},
                                PostForm{"linuxcnc", machines::TcpMode::none, 0.1, true},
                                PostForm{"linuxcnc", machines::TcpMode::angles, 0.1, true},
                                PostForm{"linuxcnc", machines::TcpMode::angles, 0.1, false},
                                PostForm{"fanuc", machines::TcpMode::none, 0, false},
                                PostForm{"fanuc", machines::TcpMode::none, 0.1, true},
                                PostForm{"fanuc", machines::TcpMode::angles, 0.1, true},
                                PostForm{"fanuc", machines::TcpMode::none, 0.1, false},
                                PostForm{"fanuc", machines::TcpMode::angles, 0.1, false},
                                PostForm{"mitsubishi_m80", machines::TcpMode::none, 0.1, true},
                                PostForm{"siemens", machines::TcpMode::none, 0.1, false},
                                PostForm{"siemens", machines::TcpMode::none, 0.1, true},
                                PostForm{"siemens", machines::TcpMode::angles, 0.1, false},
                                PostForm{"siemens", machines::TcpMode::angles, 0.1, false, 0, true},
                                PostForm{"siemens", machines::TcpMode::angles, 0.1, true, 0, true},
                                PostForm{"siemens", machines::TcpMode::vectors, 0.1, false},
                                PostForm{"siemens", machines::TcpMode::vectors, 0.1, true},
                                PostForm{"heidenhain", machines::TcpMode::none, 0, false},
                                PostForm{"heidenhain", machines::TcpMode::angles, 0, false},
                                PostForm{"heidenhain", machines::TcpMode::angles, 0.1, true},
                                PostForm{"heidenhain", machines::TcpMode::angles, 0.1, false},
                                PostForm{"heidenhain", machines::TcpMode::vectors, 0.1, true}}) {
        list.push_back(f);
        list.back().rollover = sense;
      }
    return list;
  }();
  return forms;
}

/// Every form, C counted continuously and rolling over.
inline const std::vector<PostForm>& post_forms() {
  static const std::vector<PostForm> forms = {{"linuxcnc", machines::TcpMode::none, 0.1, false},
                                              {"linuxcnc", machines::TcpMode::none, 0.1, true},
                                              {"linuxcnc", machines::TcpMode::angles, 0.1, true},
                                              {"fanuc", machines::TcpMode::none, 0, false},
                                              {"fanuc", machines::TcpMode::none, 0.1, true},
                                              {"fanuc", machines::TcpMode::angles, 0.1, true},
                                              {"fanuc", machines::TcpMode::none, 0.1, false},
                                              {"fanuc", machines::TcpMode::angles, 0.1, false},
                                              {"haas", machines::TcpMode::none, 0.1, false},
                                              {"heidenhain", machines::TcpMode::angles, 0.1, false},
                                              {"mitsubishi_m80", machines::TcpMode::none, 0, false},
                                              {"haas", machines::TcpMode::none, 0.1, true},
                                              {"siemens", machines::TcpMode::none, 0.1, false},
                                              {"siemens", machines::TcpMode::angles, 0.1, false},
                                              {"siemens", machines::TcpMode::vectors, 0.1, false},
                                              {"siemens", machines::TcpMode::vectors, 0.1, true},
                                              {"heidenhain", machines::TcpMode::none, 0, false},
                                              {"heidenhain", machines::TcpMode::angles, 0, false},
                                              {"heidenhain", machines::TcpMode::vectors, 0.1, true},
                                              {"apt", machines::TcpMode::vectors, 0.1, true},
                                              {"linuxcnc", machines::TcpMode::angles, 0.1, false},
                                              {"siemens", machines::TcpMode::angles, 0.1, false, 0, true},
                                              {"siemens", machines::TcpMode::angles, 0.1, true, 0, true}};
  static const std::vector<PostForm> all = [] {
    std::vector<PostForm> list = forms;
    for (const auto& f : rollover_forms()) list.push_back(f);
    return list;
  }();
  return all;
}

/// The axis has no ends; `sense`: of its words against the index of a gear that stands on it.
inline void roll_over(machines::RotaryAxis& axis, int sense) {
  axis.rollover = true;
  axis.sign = sense;
  axis.max_rad = std::numeric_limits<double>::infinity();
  axis.min_rad = -axis.max_rad;
}

inline machines::Machine machine_of(const PostForm& f) {
  machines::Machine m = trunnion_with(f.dialect, f.tcp);
  m.post.transformation_takes_rotary_offset = f.granted;
  if (f.rollover != 0) roll_over(m.chain.table[0], f.rollover);
  return m;
}

inline Result<joints::AxisProgram> program_of(const PostForm& f, const std::vector<path::ClPath>& paths, int teeth,
                                              int stride) {
  const machines::Machine m = machine_of(f);
  auto dialect = controls::dialect_of(m);
  if (!dialect) return dialect.error();
  joints::AxisOptions o = controls::axis_options(*dialect, m);
  o.expand_teeth = f.expand;
  o.tooth_stride = stride;
  return joints::AxisProgramTestAccess::build(paths, tools(), standing(), m, teeth, kBody, o);
}

inline Result<text::NcText> text_of(const PostForm& f, const joints::AxisProgram& program) {
  text::NcHeader header;
  header.job_name = "sample";
  header.machine_name = "trunnion";
  header.coolant = machines::Coolant::flood;
  return write_nc(program, *controls::dialect_of(machine_of(f)), header);
}

/// A form with its teeth in sequence, or spread.
struct OrderedForm {
  PostForm form;
  int stride = 1;
};
inline void PrintTo(const OrderedForm& c, std::ostream* out) {
  PrintTo(c.form, out);
  *out << "_stride" << c.stride;
}
inline std::vector<OrderedForm> ordered_forms() {
  std::vector<OrderedForm> out;
  for (const auto& f : post_forms())
    for (const int stride : {1, 2}) out.push_back({f, stride});
  return out;
}

}  // namespace toothpath::test
