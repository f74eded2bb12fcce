// Lines of NC text per second: the project's fixed-point printer, std::to_chars and an output stream, on the same words. The
// counter `max_error_mm` is the greatest distance of a printed X word from the number that it stands for.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "postproc/fixed_point.h"

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
      append_fixed(out, to_fixed(l.word[i], i < 3 ? kLinear : kRotary), i < 3 ? kLinear : kRotary, false);
      out += ' ';
    }
    out += 'F';
    append_fixed(out, to_fixed_down(l.feed, 3), 3, false);
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
    for (int i = 0; i < 5; ++i) stream << "XYZAC"[i] << std::setprecision(i < 3 ? kLinear : kRotary) << l.word[i] << ' ';
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

}  // namespace

BENCHMARK(run<print_fixed>)->Name("nc_lines/fixed_point")->Arg(1000)->Arg(100000);
BENCHMARK(run<print_to_chars>)->Name("nc_lines/to_chars")->Arg(1000)->Arg(100000);
BENCHMARK(run<print_stream>)->Name("nc_lines/iostream")->Arg(1000)->Arg(100000);
BENCHMARK_MAIN();
