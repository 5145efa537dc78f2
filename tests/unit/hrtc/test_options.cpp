// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/options.hpp"
#include "platform/hrtc/subcommands.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "tests/unit/host_cli/command_lines.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tactus::hrtc
{

namespace
{

using tactus::test::expect_refused;
using tactus::test::refusal_of;
using tactus::test::RefusedLine;
using tactus::test::RefusedValues;
using tactus::test::shown_by;
using tactus::test::words_of;

/// As main() does, but for the run.
int parse(int argc, char** argv)
{
    if (const Subcommand* subcommand = find_subcommand(argc, argv))
    {
        return subcommand->run(argc - 1, argv + 1);
    }
    const auto parsed = parse_options(argc, argv, {});
    const int* code = std::get_if<int>(&parsed);
    return code == nullptr ? kExitDone : *code;
}

/// Works in a folder of its own, where some files are.
class HrtcOptions : public testing::Test
{
protected:
    HrtcOptions() { std::filesystem::current_path(folder_.path()); }
    ~HrtcOptions() override { std::filesystem::current_path(before_); }
    HrtcOptions(const HrtcOptions&) = delete;
    HrtcOptions& operator=(const HrtcOptions&) = delete;
    HrtcOptions(HrtcOptions&&) = delete;
    HrtcOptions& operator=(HrtcOptions&&) = delete;

    const std::filesystem::path before_{std::filesystem::current_path()};
    const tactus::test::TemporaryFolder folder_{"options"};
};

const std::string kNoName = " is not 1 to 63 characters of A-Z a-z 0-9 . _ -";
const std::string kNoModel = "a model is required: hrtc FILE.spm, or --model NAME of one that is "
                             "published; see --help";
const std::string kNoCommand = " is no command (doctor, deadline-test, load)";
const std::string kMesh = "'mesh.obj' is a mesh; spm_build mesh.obj -o MODEL.spm makes a model of "
                          "it";
const std::string kSimForms = "sim, or sim:CLASS with touch, omega or delta";
const std::string kUdpForms = "udp, udp:PORT, or udp:ADDRESS:PORT with a numeric IPv4 address and "
                              "a port of 1024 to 65535";
const std::string kDhdForms = "dhd, or dhd:INDEX with 0 to 63";
const std::string kReplayForms = "replay:FILE with what hrtc --record wrote";
const std::string kDeviceForms = kSimForms + "; " + kUdpForms + "; " + kDhdForms +
                                 "; plugin:FILE[,WORDS] with a library that has a "
                                 "TACTUS_DEVICE_PLUGIN; " +
                                 kReplayForms;
const std::string kLimitNames =
    "mass_kg, damping_n_s_per_m, friction_n, quantum_m, delay_s, force_max_n, slew_max_n_per_s, "
    "stiffness_max_n_per_m, added_damping_max_n_s_per_m, turn.torque_max_nm, turn.inertia_kg_m2, "
    "turn.damping_nm_s_per_rad, turn.friction_nm, turn.quantum_rad, turn.slew_max_nm_per_s, "
    "turn.stiffness_max_nm_per_rad, turn.added_damping_max_nm_s_per_rad";
const std::string kMotionForms =
    "script, free, approach, slide, tap, teleport, spin, tremor, turn, edge or peg, perhaps with "
    ":MODEL behind it";

TEST_F(HrtcOptions, in_lines_that_no_run_can_begin_with_are_refused)
{
    folder_.write("ball.spm", "");
    std::string faults;
    for (int i = 0; i < 65; ++i)
    {
        faults += " --device-fault nan@" + std::to_string(i) + "+1";
    }
    const RefusedLine lines[] = {
        // Nothing, commands, words that mean nothing.
        {"hrtc", "hrtc: " + kNoModel},
        {"hrtc --record run.rec", "hrtc: " + kNoModel},
        {"hrtc deadline-test", "hrtc deadline-test: " + kNoModel},
        {"hrtc touch ball.spm",
         "hrtc: 'touch'" + kNoCommand +
             " and no model's or scene's file (.spm, .gltf, .glb); a published model is --model "
             "NAME"},
        {"hrtc --allow-no-rt doctor",
         "hrtc: 'doctor'" + kNoCommand +
             " and no model's or scene's file (.spm, .gltf, .glb); a published model is --model "
             "NAME"},
        {"hrtc ball", "hrtc: 'ball': the file is called 'ball.spm'"},
        {"hrtc doctor extra", "hrtc doctor: 'extra': nothing takes this word; see --help"},
        {"hrtc doctor --jason", "hrtc doctor: --jason: no option is called so; --json?"},
        {"hrtc --doctor --fast", "hrtc doctor: --fast: no option is called so; --wait?"},
        {"hrtc doctor --cpu", "hrtc doctor: --cpu: a value is missing; see --help"},
        {"hrtc doctor --domain 233",
         "hrtc doctor: --domain: '233' is not a whole number in 0 .. 232; see --help"},
        {"hrtc doctor --wait 1", "hrtc doctor: --wait requires --domain; see --help"},
        {"hrtc load", "hrtc load: KIND is required; see --help"},
        {"hrtc load gpu", "hrtc load: KIND: 'gpu' is not cpu, memory or disk; see --help"},
        // Files in place of models, models in place of files.
        {"hrtc mesh.obj", "hrtc: --model: " + kMesh},
        {"hrtc --model mesh.obj", "hrtc: --model: " + kMesh},
        {"hrtc --transport file --model mesh.obj", "hrtc: --model: " + kMesh},
        {"hrtc --transport file --model ball.spm@00000000000000000000000000000000",
         "hrtc: --model: 'ball.spm@00000000000000000000000000000000': a hash is of published "
         "models; a file is given without"},
        {"hrtc a.gltf b.gltf", "hrtc: 'b.gltf': a second scene; one can be touched"},
        {"hrtc --scene a.gltf --model ball.spm",
         "hrtc: --scene: takes the place of --model, --place and --material"},
        {"hrtc --transport dds --scene a/b.gltf", "hrtc: --scene: 'a/b.gltf'" + kNoName},
        // Options that are not there, or without a value, or twice.
        {"hrtc ball.spm --=", "hrtc: --: no option is called so; see --help"},
        {"hrtc ball.spm --fast", "hrtc: --fast: no option is called so; --wait?"},
        {"hrtc ball.spm --units mm", "hrtc: --units: no option is called so; see --help"},
        {"hrtc ball.spm --stifness 300", "hrtc: --stifness: no option is called so; --stiffness?"},
        {"hrtc ball.spm --stifness=300", "hrtc: --stifness: no option is called so; --stiffness?"},
        {"hrtc ball.spm --time 5", "hrtc: --time: no option is called so; --name?"},
        {"hrtc ball.spm --reports a.json", "hrtc: --reports: no option is called so; --report?"},
        {"hrtc ball.spm -d 5", "hrtc: -d: no option is called so; see --help"},
        {"hrtc --model", "hrtc: --model: a value is missing; see --help"},
        {"hrtc --model --wait 3", "hrtc: --model: a value is missing; see --help"},
        {"hrtc ball.spm --report --strict", "hrtc: --report: a value is missing; see --help"},
        {"hrtc ball.spm --rate= --duration 1", "hrtc: --rate: a value is missing; see --help"},
        {"hrtc ball.spm --config", "hrtc: --config: a value is missing; see --help"},
        {"hrtc ball.spm --record", "hrtc: --record: a value is missing; see --help"},
        {"hrtc ball.spm --duration 1 --duration 2", "hrtc: --duration: is given twice; see --help"},
        // What one option alone can't tell.
        {"hrtc ball.spm --cache-mib 3", "hrtc: --cache-mib: must be less than --pool-mib"},
        {"hrtc ball.spm --cache-mib 2", "hrtc: --cache-mib: must be less than --pool-mib"},
        {"hrtc ball.spm --frame-budget-us 1000",
         "hrtc: --frame-budget-us: must be less than the period of 1000 us"},
        {"hrtc ball.spm --rate 4000 --frame-budget-us 300",
         "hrtc: --frame-budget-us: must be less than the period of 250 us"},
        {"hrtc ball.spm --virtual-time --cpu 1",
         "hrtc: --virtual-time: there is no real-time thread that --cpu could be for"},
        {"hrtc ball.spm --virtual-time --priority 90",
         "hrtc: --virtual-time: there is no real-time thread that --priority could be for"},
        {"hrtc ball.spm --virtual-time --supervisor-periods 5",
         "hrtc: --virtual-time: there is no real-time thread that --supervisor-periods could be "
         "for"},
        {"hrtc --virtual-time --model ball",
         "hrtc: --virtual-time: takes models from files; hosts keep to the time of day"},
        {"hrtc --virtual-time ball.spm --device udp",
         "hrtc: --virtual-time: takes devices that are simulated or recorded; others keep to the "
         "time of day"},
        {"hrtc --virtual-time ball.spm --frame-budget-us 100",
         "hrtc: --virtual-time: a frame takes no time there that --frame-budget-us could limit"},
        {"hrtc --virtual-time ball.spm --trace a",
         "hrtc: --virtual-time: takes no time that --trace could tell of"},
        {"hrtc --virtual-time ball.spm --histograms a",
         "hrtc: --virtual-time: takes no time that --histograms could tell of"},
        {"hrtc ball.spm --report a.json --report a.json",
         "hrtc: --report: 'a.json' is given twice"},
        {"hrtc ball.spm --record a.json --report a.json",
         "hrtc: --record: must be another file than --report"},
        {"hrtc ball.spm --trace a.json --report a.json",
         "hrtc: --trace: must be another file than --report"},
        {"hrtc ball.spm --record a --trace a", "hrtc: --trace: must be another file than --record"},
        {"hrtc ball.spm --export a.csv", "hrtc: --export: needs --replay"},
        {"hrtc --replay a.rec --export a.xml",
         "hrtc: --export: 'a.xml' ends neither in .csv nor in .jsonl or .mcap"},
        {"hrtc --replay a.rec --export a.csv --export a.csv",
         "hrtc: --export: 'a.csv' is given twice"},
        {"hrtc --replay a.csv --export a.csv",
         "hrtc: --export: must be another file than --replay"},
        // Tools, devices, places, materials.
        {"hrtc ball.spm --tools 2 --tool sphere:0.01",
         "hrtc: --tools: 2, but --tool is given 1 times"},
        {"hrtc ball.spm --tool-mass 1 --tool-mass 1", "hrtc: --tool-mass: 2 given for 1 tools"},
        {"hrtc ball.spm --guide none --guide none", "hrtc: --guide: 2 given for 1 tools"},
        {"hrtc ball.spm --smooth 0.005 --tool box:0.01,0.01,0.01",
         "hrtc: --smooth: no --tool is a point or a sphere, and others feel each facet"},
        {"hrtc ball.spm --motion tap --motion slide", "hrtc: --motion: 2 given for 1 tools"},
        {"hrtc ball.spm --device udp --motion free",
         "hrtc: --motion: there is no simulated device"},
        {"hrtc ball.spm --device udp --device-fault nan@1+1",
         "hrtc: --device-fault: there is no simulated device"},
        {"hrtc ball.spm" + faults, "hrtc: --device-fault: at most 64 faults"},
        {"hrtc ball.spm --device sim --device sim", "hrtc: --device: 2 given for 1 tools"},
        {"hrtc ball.spm --tools 2 --device sim --device sim --device sim",
         "hrtc: --device: 3 given for 2 tools"},
        {"hrtc ball.spm --device-key missing.key", "hrtc: --device-key: there is no udp device"},
        {"hrtc ball.spm --device-frame 0,0,0", "hrtc: --device-frame: 1 given for 0 of --device"},
        {"hrtc ball.spm --device sim --device-frame 0,0,0",
         "hrtc: --device-frame: a simulated or recorded hand is in the world already"},
        {"hrtc ball.spm --device replay:a.rec --device-frame 0,0,0",
         "hrtc: --device-frame: a simulated or recorded hand is in the world already"},
        {"hrtc ball.spm --device udp --device-limits mass_kg=0.2",
         "hrtc: --device-limits: 'mass_kg=0.2': no sim or dhd device is left; others tell their "
         "own"},
        {"hrtc ball.spm --device-limits mass_kg=0.2 --device-limits mass_kg=0.2",
         "hrtc: --device-limits: 'mass_kg=0.2': no sim or dhd device is left; others tell their "
         "own"},
        {"hrtc ball.spm --place 0,0,0 --place 1,0,0 --objects 1",
         "hrtc: --objects: 1; 2 are there from the start"},
        {"hrtc ball.spm --material 100 --material 200", "hrtc: --material: 2 given for 1 objects"},
    };
    expect_refused(parse, lines);
}

TEST_F(HrtcOptions, with_values_that_they_do_not_take_are_refused_by_name)
{
    const std::vector<std::string> no_names{"",     "a b",         "\xC3\xA4",
                                            "a\nb", "\x1b[31mred", std::string(64, 'n')};
    const RefusedValues values[] = {
        // Numbers.
        {"hrtc ball.spm --rate",
         {"0", "-1", "50", "99", "10001", "1e300", "nan", "fast", "1k", "1000.5", ""},
         "hrtc: --rate: '{}' is not a whole number in 100 .. 10000; see --help"},
        {"hrtc ball.spm --duration",
         {"0", "-1", "86401", "inf", "nan", "long", "5s"},
         "hrtc: --duration: '{}' is not a number in 0.1 .. 86400; see --help"},
        {"hrtc ball.spm --pool-mib",
         {"0", "0.2", "4097", "nan", "big"},
         "hrtc: --pool-mib: '{}' is not a number in 0.25 .. 4096; see --help"},
        {"hrtc ball.spm --cache-mib",
         {"0"},
         "hrtc: --cache-mib: '{}' is not a number in 0.05 .. 4096; see --help"},
        {"hrtc ball.spm --splits",
         {"0", "-1", "500", "1000000", "1.5", "many"},
         "hrtc: --splits: '{}' is not a whole number in 1 .. 256; see --help"},
        {"hrtc ball.spm --frame-budget-us",
         {"0", "0.9", "10001", "nan", "soon", ""},
         "hrtc: --frame-budget-us: '{}' is not a number in 1 .. 10000; see --help"},
        {"hrtc ball.spm --stiffness",
         {"0", "3001", "5000"},
         "hrtc: --stiffness: '{}' is not a number in 1 .. 3000; see --help"},
        {"hrtc ball.spm --angular-stiffness",
         {"0", "101", "-1", "stiff", "nan"},
         "hrtc: --angular-stiffness: '{}' is not a number in 0.001 .. 100; see --help"},
        {"hrtc ball.spm --smooth",
         {"0", "0.2", "-1", "soft", "nan"},
         "hrtc: --smooth: '{}' is not a number in 0.0001 .. 0.1; see --help"},
        {"hrtc ball.spm --speed-limit",
         {"0", "-1", "0.009", "101", "nan", "fast", ""},
         "hrtc: --speed-limit: '{}' is not a number in 0.01 .. 100; see --help"},
        {"hrtc ball.spm --clutch",
         {"-1", "32", "1.5", "left"},
         "hrtc: --clutch: '{}' is not a whole number in 0 .. 31; see --help"},
        {"hrtc ball.spm --domain",
         {"-1", "233", "1.5"},
         "hrtc: --domain: '{}' is not a whole number in 0 .. 232; see --help"},
        {"hrtc ball.spm --wait",
         {"0"},
         "hrtc: --wait: '{}' is not a number in 0.1 .. 3600; see --help"},
        {"hrtc ball.spm --priority",
         {"0", "99"},
         "hrtc: --priority: '{}' is not a whole number in 1 .. 98; see --help"},
        {"hrtc ball.spm --supervisor-periods",
         {"1", "1001"},
         "hrtc: --supervisor-periods: '{}' is not a whole number in 2 .. 1000; see --help"},
        {"hrtc ball.spm --cpu",
         {"-1", "1024", "5000"},
         "hrtc: --cpu: '{}' is not a whole number in 0 .. 1023; see --help"},
        {"hrtc doctor --cpu",
         {"-1", "1024", "all", "1.5", ""},
         "hrtc doctor: --cpu: '{}' is not a whole number in 0 .. 1023; see --help"},
        {"hrtc ball.spm --objects",
         {"0", "4097", "-1", "many"},
         "hrtc: --objects: '{}' is not a whole number in 1 .. 4096; see --help"},
        {"hrtc ball.spm --tools",
         {"0", "17", "-1"},
         "hrtc: --tools: '{}' is not a whole number in 1 .. 16; see --help"},
        // Words.
        {"hrtc --model ball --transport",
         {"smtp"},
         "hrtc: --transport: '{}' is not dds or file; see --help"},
        {"hrtc ball.spm --predict",
         {"tarot"},
         "hrtc: --predict: '{}' is not local, linear, quadratic, distance or auto; see --help"},
        {"hrtc ball.spm --report",
         {"a.csv", "a.htm", "run", "run.htm", "run.JSON", "json"},
         "hrtc: --report: '{}' ends neither in .json nor, for a page, in .html"},
        {"hrtc ball.spm --record", {""}, "hrtc: --record: a file's name is needed"},
        {"hrtc ball.spm --replay", {""}, "hrtc: --replay: a file's name is needed"},
        {"hrtc ball.spm --trace", {""}, "hrtc: --trace: a file's name is needed"},
        {"hrtc ball.spm --histograms", {""}, "hrtc: --histograms: a file's name is needed"},
        {"hrtc ball.spm",
         {"docter", "folder"},
         "hrtc: '{}'" + kNoCommand +
             " and no model's or scene's file (.spm, .gltf, .glb); a published model is --model "
             "NAME"},
        {"hrtc --model", no_names, "hrtc: --model: name '{}'" + kNoName},
        {"hrtc --model ball --name", no_names, "hrtc: --name: '{}'" + kNoName},
        {"hrtc --model ball --name", {"two/words"}, "hrtc: --name: '{}'" + kNoName},
        // Tools.
        {"hrtc ball.spm --tool",
         {"ball",        "cube",          "sphere:",    "sphere:0",   "sphere:0.1,1",
          "capsule:0.1", "capsule:0,0.1", "box:1,1",    "box:1,1,0",  "box:1,1,1,2",
          "hull:",       "hull:a.obj,2",  "mesh:",      "mesh:,0.1",  "sphere:1.1",
          "sphere:5",    "sphere:nan",    "sphere:1mm", "sphere:5mm", "sphere:\x1b[2J"},
         "hrtc: --tool: '{}' is not point, sphere:R, capsule:R,L, box:X,Y,Z[,R], hull:FILE[,R] or "
         "mesh:NAME[,R], with lengths of 1e-5 to 1 m, or an R of 0 behind others"},
        {"hrtc ball.spm --tool-mass",
         {"-1", "5.1", "20", "1,2", "1,0,0,2", "nan", "1kg", ""},
         "hrtc: --tool-mass: '{}' is not KG[,X,Y,Z]: 0 to 5 kg, and its centre in metres, within "
         "1 m"},
        {"hrtc ball.spm --guide",
         {"point:1,2", "line:0,0,0", "plane:0,0,0,0,0,0", "cone:1,2,3", "point:0,0,0,5000", ""},
         "hrtc: --guide: '{}' is not point:X,Y,Z[,K[,F]], line:X,Y,Z,DX,DY,DZ[,K[,F]] or "
         "plane:X,Y,Z,NX,NY,NZ[,K[,F]], with places within 1000 m, a direction that is not zero, "
         "1 <= K <= 3000 N/m and 0.01 <= F <= 100 N"},
        // Devices.
        {"hrtc ball.spm --device",
         {"phantom", "omega", ""},
         "hrtc: --device: '{}' is not " + kDeviceForms},
        {"hrtc ball.spm --device",
         {"sim:", "sim:sigma"},
         "hrtc: --device: '{}' is not " + kSimForms},
        {"hrtc ball.spm --device",
         {"udp:", "udp:80", "udp:65536", "udp:5x", "udp::48500", "udp:0.0.0.0"},
         "hrtc: --device: '{}' is not " + kUdpForms},
        {"hrtc ball.spm --device",
         {"dhd:", "dhd:64", "dhd:-1", "dhd:99"},
         "hrtc: --device: '{}' is not " + kDhdForms},
        {"hrtc ball.spm --device",
         {"replay", "replay:"},
         "hrtc: --device: '{}' is not " + kReplayForms},
        {"hrtc ball.spm --device udp --device-frame",
         {"1,2"},
         "hrtc: --device-frame: '{}' is not X,Y,Z[,RX,RY,RZ[,SCALE]] with at most 1e4 m, 360 "
         "degrees and a scale of 1e-3 to 1e3"},
        {"hrtc ball.spm --device sim --device-limits",
         {"mass=0.2"},
         "hrtc: --device-limits: '{}' is not KEY=VALUE with one of " + kLimitNames},
        {"hrtc ball.spm --device-limits",
         {"mass_kg=light"},
         "hrtc: --device-limits: mass_kg: 'light' is not a number"},
        {"hrtc ball.spm --device-limits",
         {"mass_kg=0"},
         "hrtc: --device-limits: device: mass_kg must be finite and > 0"},
        {"hrtc ball.spm --device-fault",
         {"later", "nan", "nan@1", "nan@1+0", "nan@-1+1", "nan@1+2000000000", "late@1+1", ""},
         "hrtc: --device-fault: '{}' is not KIND@FRAME+LENGTH with the kind jitter, dropout, "
         "stuck, nan, time_jump or disconnect, a frame of 0 to 1e9 and a length of 1 to 1e9 "
         "frames"},
        {"hrtc ball.spm --motion",
         {"fly", "tap:", ""},
         "hrtc: --motion: '{}' is not " + kMotionForms},
        // Objects.
        {"hrtc ball.spm --place",
         {"1", "1,2", "1,2,3,4", "1,2,x", "1,2,3,400,0,0", "1,2,3,0,0,0,0", "nan,0,0", "2e4,0,0",
          "1mm,0,0", ""},
         "hrtc: --place: '{}' is not X,Y,Z[,RX,RY,RZ[,SCALE]] with at most 1e4 m, 360 degrees and "
         "a scale of 1e-3 to 1e3"},
        {"hrtc ball.spm --material",
         {"0.5", "3001", "soft", "500,-0.1", "500,3.1", "500,0.5,0.6", "500,1,1,21", "500,1,1,1,1",
          "nan", "500,", "", "stiffness=0", "static=0.1,static=0.1", "dynamic=0.1", "texture=1"},
         "hrtc: --material: '{}' is not STIFFNESS[,STATIC[,DYNAMIC[,DAMPING]]], or any of "
         "stiffness=, static=, dynamic=, damping=, viscosity=, texture_height= and "
         "texture_length=, with 1 to 3000 N/m, friction of 0 to 3, the dynamic one at most the "
         "static one, damping and viscosity of 0 to 20 N s/m, and a texture's height of at most "
         "1/32 of its length of 0.0001 to 1 m"},
    };
    expect_refused(parse, values);

    for (const std::string& hash : {std::string("12"), std::string(32, 'g')})
    {
        EXPECT_EQ(refusal_of(parse, {"hrtc", "--model", "ball@" + hash}),
                  "hrtc: --model: hash '" + hash + "' is not 32 hexadecimal digits\n");
    }
    // What follows depends on the processor.
    const std::string kernels = "hrtc: --kernels: 'sse' is none that this processor runs: portable";
    EXPECT_EQ(refusal_of(parse, words_of("hrtc ball.spm --kernels sse")).substr(0, kernels.size()),
              kernels);
}

TEST_F(HrtcOptions, beside_a_replay_are_refused)
{
    for (const char* option :
         {"--model a", "--record a", "--duration 1", "--rate 1000", "--frame-budget-us 100",
          "--splits 100", "--report a.json", "--allow-no-rt"})
    {
        const std::string name = words_of(option).front();
        const RefusedLine lines[] = {
            {"hrtc --replay run.rec " + std::string(option),
             "hrtc: --replay: takes --kernels, --export and no other option; " + name +
                 " was given"}};
        expect_refused(parse, lines);
    }
}

TEST_F(HrtcOptions, of_a_file_are_refused_with_their_place_in_it)
{
    struct RefusedFile
    {
        std::string text;
        std::string said;
    };
    const RefusedFile files[] = {
        {"model = \"ball.spm\"\nstifness = 300",
         "--config: bad.toml:2: no option is called 'stifness'; 'stiffness'?"},
        {"# Mine.\nrate = 1000\n  stifness = 300",
         "--config: bad.toml:3: no option is called 'stifness'; 'stiffness'?"},
        {"buoyancy = 3",
         "--config: bad.toml:1: no option is called 'buoyancy'; a line is KEY = VALUE"},
        {"[loop]\nrate = 1000", "--config: bad.toml:1: there are no sections; '[loop]' is one"},
        {"\n[loop]\nrate = 1000", "--config: bad.toml:2: there are no sections; '[loop]' is one"},
        {"model: ball.spm",
         "--config: bad.toml:1: no option is called 'ball.spm'; a line is KEY = VALUE"},
        {"splits: quickly",
         "--config: bad.toml:1: no option is called 'quickly'; a line is KEY = VALUE"},
        {"# Mine.\nmodel = [", "bad.toml:2: --model: name '['" + kNoName},
        {"model = \"ball.spm\"\n\nrate = \"1k\"",
         "bad.toml:3: --rate: '1k' is not a whole number in 100 .. 10000; see --help"},
        {"rate = \"fast\"",
         "bad.toml:1: --rate: 'fast' is not a whole number in 100 .. 10000; see --help"},
        {"rate = 99", "bad.toml:1: --rate: '99' is not a whole number in 100 .. 10000; see --help"},
        {"rate =", "bad.toml:1: --rate: '' is not a whole number in 100 .. 10000; see --help"},
        {"rate = [1000, 2000]", "bad.toml:1: --rate: is given twice; see --help"},
        {"cpu = 1.5", "bad.toml:1: --cpu: '1.5' is not a whole number in 0 .. 1023; see --help"},
        {"pool-mib = 0", "bad.toml:1: --pool-mib: '0' is not a number in 0.25 .. 4096; see --help"},
        {"no-static = \"maybe\"", "Could not convert: --no-static = maybe; see --help"},
        {"device = \"phantom\"\nmodel = \"a\"",
         "bad.toml:1: --device: 'phantom' is not " + kDeviceForms},
        {"model = \"ball.spm\"\ndevice = \"udp:80\"",
         "bad.toml:2: --device: 'udp:80' is not " + kUdpForms},
        {"config = \"other.toml\"", "config: This option is not allowed in a configuration file"},
    };
    for (const auto& [text, said] : files)
    {
        folder_.write("bad.toml", text + "\n");
        SCOPED_TRACE(text);
        EXPECT_EQ(refusal_of(parse, words_of("hrtc --config bad.toml")), "hrtc: " + said + "\n");
    }
}

TEST_F(HrtcOptions, of_files_that_cannot_be_read_are_no_wrong_usage)
{
    std::filesystem::create_directory("folder");
    const RefusedLine lines[] = {
        {"hrtc --config missing.toml",
         "hrtc: --config: missing.toml: can't be read, or is no file"},
        {"hrtc --config folder", "hrtc: --config: folder: can't be read, or is no file"},
        {"hrtc ball.spm --device udp --device-key missing.key",
         "hrtc: --device-key: missing.key: no such file"},
    };
    expect_refused(parse, lines, kExitFailed);
}

TEST_F(HrtcOptions, come_to_a_file_that_reads_as_they_do)
{
    folder_.write("good.toml",
                  "model = [\"ball\", \"torus\"]\nplace = [\"0,0,0\", \"1,0,0\"]\nrate = 2000\n");
    const std::string all = shown_by(parse, "hrtc --config good.toml --rate 4000 --print-config");
    EXPECT_NE(all.find("\nrate=4000\n"), std::string::npos) << "the command line goes first";
    EXPECT_NE(all.find("\nplace=[\"0,0,0\", \"1,0,0\"]\n"), std::string::npos) << all;
    folder_.write("all.toml", all);
    EXPECT_EQ(shown_by(parse, "hrtc --config all.toml --print-config"), all);
}

TEST_F(HrtcOptions, are_explained_in_printable_text)
{
    const std::string help = shown_by(parse, "hrtc --help");
    EXPECT_NE(help.find("--pool-mib"), std::string::npos);
    for (const char c : help)
    {
        EXPECT_TRUE(is_printable(c) || c == '\n') << help;
    }
    EXPECT_NE(shown_by(parse, "hrtc doctor --help").find("--json"), std::string::npos);
    EXPECT_EQ(shown_by(parse, "hrtc --doctor --help"), shown_by(parse, "hrtc doctor --help"));
    EXPECT_EQ(shown_by(parse, "hrtc --version").substr(0, 5), "hrtc ");
}

} // namespace

} // namespace tactus::hrtc
