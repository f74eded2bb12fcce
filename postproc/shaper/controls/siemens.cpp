// Siemens 840D sl: coupling by EGDEF, EGON and EGOFS, the ram as an oscillating axis (OS).
#include <fmt/format.h>

#include "postproc/shaper/control.h"
#include "postproc/shaper/controls/siemens_reader.h"
#include "postproc/shaper/gearbox_writer.h"

namespace toothpath::shaper {
namespace {

class SiemensWriter : public GearboxWriter {
 public:
  explicit SiemensWriter(const ShaperSetup& setup) : GearboxWriter(setup, {5, 6, 5, false, "; ", ""}) {}

 private:
  void begin() override {
    out_ += comment(s_.job_name);
    line("G17 G40 G90 G94 G710 G64 G500");
  }
  [[nodiscard]] std::string zero_offsets() const override { return "the basic frames must be 0 in every axis (G500)"; }
  [[nodiscard]] std::string clear_block(const std::string& x) const override { return "SUPA G0 X" + x + " D0"; }
  [[nodiscard]] std::string turn_word(const std::string& axis, const std::string& number) const override {
    return axis + "=" + number;
  }
  void couple(const char* sign, std::int64_t top, std::int64_t bottom) override {
    line(fmt::format("EGDEF({},{},1)", box_.work_axis, box_.cutter_axis));
    line(fmt::format("EGON({},\"FINE\",{},{}{},{})", box_.work_axis, box_.cutter_axis, sign, top, bottom));
  }
  void ram_on(double speed) override {
    line("OSP1[Z]=" + length(s_.start_mm) + " OSP2[Z]=" + length(s_.end_mm));
    line("FA[Z]=" + feed(speed) + " OSCTRL[Z]=(1,0) OSE[Z]=" + length(s_.start_mm));
    line("OS[Z]=1");
  }
  void ram_off() override {
    line("OS[Z]=0");
    line("WAITP(Z)");
  }
  void finish() override {
    line("EGOFS(" + box_.work_axis + ")");
    line("EGDEL(" + box_.work_axis + ")");
    line("M30");
  }
};

}  // namespace

ShaperControl siemens() {
  ShaperControl c;
  c.dialect = {"siemens", machines::ShaperGears::named_axes};
  c.extension = ".mpf";
  c.coupling_words = "EGDEF, EGON, EGOFS";
  c.program = [](const ShaperSetup& setup) { return SiemensWriter(setup).run(); };
  c.read = read_siemens_gearbox;
  return c;
}

}  // namespace toothpath::shaper
