// Blocks per second on one core, written and read, for every dialect with and without TCP (nc_write/.., nc_read/..);
// the counter `rounding_mm` is the proven bound of the printed words, `worst_mm` what the read-back finds at the ends
// of the blocks. And lines of NC text per second: the project's fixed-point printer, std::to_chars and an output
// stream, on the same words. The counter `max_error_mm` is the greatest distance of a printed X word from the number
// that it stands for.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "postproc/numbers/fixed_point.h"
#include "postproc/readback/reader.h"
#include "postproc/text/writer.h"
#include "tests/postproc/readback/nc_case.h"

namespace {

using namespace toothpath;

constexpr int kLinear = 4, kRotary = 5;

struct Line {
  double word[5];
  double feed;
};

std::vector<Line> sample(std::size_t n) {
  std::mt19937_64 random(42);
  std::uniform_real_distribution<double> linear(-600, 600), rotary(-360, 360), feed(100, 40000);
  std::vector<Line> lines(n);
  for (auto& l : lines) {
    for (int i = 0; i < 3; ++i) l.word[i] = linear(random);
    for (int i = 3; i < 5; ++i) l.word[i] = rotary(random);
    l.feed = feed(random);
  }
  return lines;
}

double largest_error(const std::string& text, const std::vector<Line>& lines) {
  double worst = 0;
  std::size_t at = 0;
  for (const auto& l : lines) {
    at = text.find('X', at) + 1;
    double v = 0;
    std::from_chars(text.data() + at, text.data() + text.size(), v);
    worst = std::max(worst, std::abs(v - l.word[0]));
  }
  return worst;
}

void print_fixed(std::string& out, const std::vector<Line>& lines) {
  for (const auto& l : lines) {
    for (int i = 0; i < 5; ++i) {
      out += " XYZAC"[i + 1];
      toothpath::numbers::append_fixed(out, numbers::to_fixed(l.word[i], i < 3 ? kLinear : kRotary),
                                       i < 3 ? kLinear : kRotary, false);
      out += ' ';
    }
    out += 'F';
    toothpath::numbers::append_fixed(out, numbers::to_fixed_down(l.feed, 3), 3, false);
    out += '\n';
  }
}

void print_to_chars(std::string& out, const std::vector<Line>& lines) {
  char buffer[64];
  const auto put = [&](double v, int decimals) {
    out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, v, std::chars_format::fixed, decimals).ptr);
  };
  for (const auto& l : lines) {
    for (int i = 0; i < 5; ++i) {
      out += "XYZAC"[i];
      put(l.word[i], i < 3 ? kLinear : kRotary);
      out += ' ';
    }
    out += 'F';
    put(l.feed, 3);
    out += '\n';
  }
}

void print_stream(std::string& out, const std::vector<Line>& lines) {
  std::ostringstream stream;
  stream << std::fixed;
  for (const auto& l : lines) {
    for (int i = 0; i < 5; ++i)
      stream << "XYZAC"[i] << std::setprecision(i < 3 ? kLinear : kRotary) << l.word[i] << ' ';
    stream << 'F' << std::setprecision(3) << l.feed << '\n';
  }
  out = stream.str();
}

template <void (*Print)(std::string&, const std::vector<Line>&)>
void run(benchmark::State& state) {
  const auto lines = sample(static_cast<std::size_t>(state.range(0)));
  std::string out;
  for (auto _ : state) {
    out.clear();
    Print(out, lines);
    benchmark::DoNotOptimize(out.data());
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
  state.counters["max_error_mm"] = largest_error(out, lines);
}

struct Post {
  const char* name;
  const char* dialect;
  machines::TcpMode tcp;
};
constexpr Post kPosts[] = {{"linuxcnc", "linuxcnc", machines::TcpMode::none},
                           {"linuxcnc_tcp", "linuxcnc", machines::TcpMode::angles},
                           {"fanuc", "fanuc", machines::TcpMode::none},
                           {"fanuc_tcp", "fanuc", machines::TcpMode::angles},
                           {"siemens", "siemens", machines::TcpMode::none},
                           {"siemens_tcp", "siemens", machines::TcpMode::angles},
                           {"heidenhain_tcp", "heidenhain", machines::TcpMode::angles},
                           {"apt", "apt", machines::TcpMode::vectors}};

/// A long pass with a moving tool axis, one tooth.
struct Job {
  machines::Machine machine;
  path::ClPath path;
  joints::AxisProgram program;
  text::NcDialect dialect;
  std::string text;
};
Job job_of(const Post& post, int steps = 50000) {
  Job j;
  j.machine = test::with_dialect(test::trunnion(), post.dialect);
  j.machine.tcp = post.tcp;
  j.machine.post.tcp_on = post.tcp != machines::TcpMode::none && std::string(post.dialect) == "linuxcnc"
                              ? std::vector<std::string>{"M428"}
                              : std::vector<std::string>{};
  if (!j.machine.post.tcp_on.empty()) j.machine.post.tcp_off = {"M429"};
  j.path = test::sample_path(0.3, 0.4, steps);
  j.dialect = *controls::dialect_of(j.machine);
  j.program = *joints::AxisProgramTestAccess::build(std::vector{j.path}, test::tools(), test::standing(), j.machine, 1,
                                                    test::kBody, controls::axis_options(j.dialect, j.machine));
  j.text = text::write_nc(j.program, j.dialect, {})->text;
  return j;
}

void write_blocks(benchmark::State& state, const Post& post) {
  const Job j = job_of(post);
  std::size_t blocks = 0;
  for (auto _ : state) {
    const auto text = text::write_nc(j.program, j.dialect, {});
    blocks = text->blocks;
    benchmark::DoNotOptimize(text->text.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(blocks));
  state.counters["rounding_mm"] = j.program.rounding_bound_mm;
}

void read_blocks(benchmark::State& state, const Post& post) {
  const Job j = job_of(post);
  const auto control = controls::control_of(j.machine, test::standing(), test::tools());
  std::size_t blocks = 0;
  for (auto _ : state) {
    blocks = 0;
    const auto done = readback::execute_nc(j.text, "p", *control, [&](const readback::ExecutedMove&) { ++blocks; });
    if (!done) state.SkipWithError(done.error().message.c_str());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(blocks));
  // Accuracy on steps well above the last digit; what is timed above is finer than any path.
  const Job wide = job_of(post, 300);
  const auto back = readback::read_back(wide.text, "p", *control, wide.machine, test::standing(), {.teeth = 1});
  const auto motions = readback::tool_motions(back->operations[0], back->copies, *control, wide.machine,
                                              test::standing(), 1, {1e-3, 1e-3});
  const std::vector<const path::ClPath*> paths = {&wide.path};
  state.counters["worst_mm"] = readback::compare_with_cl(*motions, paths, 5e-3, 1e-3).worst_mm;
}

}  // namespace

BENCHMARK(run<print_fixed>)->Name("nc_lines/fixed_point")->Arg(1000)->Arg(100000);
BENCHMARK(run<print_to_chars>)->Name("nc_lines/to_chars")->Arg(1000)->Arg(100000);
BENCHMARK(run<print_stream>)->Name("nc_lines/iostream")->Arg(1000)->Arg(100000);
int main(int argc, char** argv) {
  for (const auto& post : kPosts) {
    benchmark::RegisterBenchmark((std::string("nc_write/") + post.name).c_str(), write_blocks, post);
    benchmark::RegisterBenchmark((std::string("nc_read/") + post.name).c_str(), read_blocks, post);
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
