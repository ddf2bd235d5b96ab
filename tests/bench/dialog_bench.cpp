#include <benchmark/benchmark.h>

#include <string>

#include "protocol/replay.hpp"
#include "tests/protocol/dialog_text.hpp"

// Bytes per second of the dialog reader (product.md 10: 200 MB/s on one core, linear in length). The dialog is made up
// in the proportions of real ones: half of its bytes are sensor lines, a quarter is housekeeping that says nothing.

using namespace glidehelm;

namespace {

std::string surfacing() {
  std::string text = test::connection_block();
  const auto sensors = [&] {
    std::string lines;
    for (int i = 0; i < 14; ++i) {
      lines += test::sensor_line("m_coulomb_amphr_total", "amp-hrs", 0.913406000000003, 3.215);
      lines += test::sensor_line("m_leakdetect_voltage_forward", "volts", 2.51318181818182, 44.105);
    }
    return lines;
  }();
  text.insert(text.find("  9000    No login"), sensors);
  auto surface = test::at_surface_block();
  surface.insert(surface.find("devices:"), sensors);
  text += surface;
  for (int i = 0; i < 20; ++i) {
    text += " 13045    SCI:           sci_seaowl_chl_scaled(ug/l)\r\n";
    text += "Total Bytes sent/received: 1024\n";
    text += "   m_tot_num_inflections(nodim) 4208.000000\r\n";
  }
  return text + "   RESUMING MISSION\r\n";
}

std::string dialog(std::size_t bytes) {
  const auto one = surfacing();
  std::string text;
  while (text.size() < bytes) text += one;
  return text;
}

void read_dialog(benchmark::State& state) {
  const auto text = dialog(static_cast<std::size_t>(state.range(0)));
  const auto chunk = static_cast<std::size_t>(state.range(1));
  for (auto _ : state) {
    protocol::DialogReader reader;
    for (std::size_t at = 0; at < text.size(); at += chunk)
      benchmark::DoNotOptimize(reader.append(std::string_view{text}.substr(at, chunk), Instant{}));
    benchmark::DoNotOptimize(reader.end(Instant{}));
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * text.size()));
}
// Lengths 64 KB … 64 MB in chunks of a page: linear when the rate stays. Then the chunks of a slow line.
BENCHMARK(read_dialog)->Args({64 << 10, 4096})->Args({1 << 20, 4096})->Args({16 << 20, 4096})->Args({64 << 20, 4096});
BENCHMARK(read_dialog)->Args({1 << 20, 64})->Args({1 << 20, 1});

/// Bytes that say nothing: binary without line ends, and lines of noise.
void read_noise(benchmark::State& state) {
  std::string text(1 << 20, '\x80');
  if (state.range(0) != 0)
    for (std::size_t i = 63; i < text.size(); i += 64) text[i] = '\n';
  for (auto _ : state) {
    protocol::DialogReader reader;
    benchmark::DoNotOptimize(reader.append(text, Instant{}));
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * text.size()));
}
BENCHMARK(read_noise)->Arg(0)->Arg(1);

}  // namespace

BENCHMARK_MAIN();
