// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/subcommands.hpp"
#include "platform/options/option_table.hpp"
#include "platform/options/options.hpp"
#include "platform/readers/file_readers.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "tests/unit/host_cli/command_lines.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace tactus::hrtc
{
namespace
{

using tactus::test::expect_refusals;
using tactus::test::refusal_of;
using tactus::test::shown_by;
using tactus::test::words_of;

/// Parses like main(), without the run.
int parse(int argc, char** argv)
{
    if (const Subcommand* subcommand = find_subcommand(argc, argv))
    {
        return subcommand->run(argc - 1, argv + 1);
    }
    const auto parsed = parse_options(argc, argv, program_form());
    const int* code = std::get_if<int>(&parsed);
    return code == nullptr ? kExitDone : *code;
}

/// Test in its own folder with some files.
struct HrtcOptions : testing::Test
{
    HrtcOptions() { std::filesystem::current_path(folder_.path()); }
    ~HrtcOptions() override { std::filesystem::current_path(before_); }
    HrtcOptions(const HrtcOptions&) = delete;
    HrtcOptions& operator=(const HrtcOptions&) = delete;
    HrtcOptions(HrtcOptions&&) = delete;
    HrtcOptions& operator=(HrtcOptions&&) = delete;

    static Options options_of(const std::string& line)
    {
        std::vector<std::string> words = words_of(line);
        std::vector<char*> arguments;
        for (std::string& word : words)
        {
            arguments.push_back(word.data());
        }
        return std::get<Options>(
            parse_options(static_cast<int>(arguments.size()), arguments.data(), program_form()));
    }

    const std::filesystem::path before_{std::filesystem::current_path()};
    const tactus::test::TemporaryFolder folder_{"options"};
};

TEST_F(HrtcOptions, are_refused_in_one_line)
{
    folder_.write("ball.spm", "");
    std::filesystem::create_directory("folder");
    EXPECT_GE(expect_refusals(parse, TACTUS_WRONG_USAGES), 417U);
    EXPECT_EQ(folder_.files(), 2U) << "nothing is left behind";
    std::string faults;
    for (int i = 0; i < 65; ++i)
    {
        faults += " --device-fault nan@" + std::to_string(i) + "+1";
    }
    EXPECT_EQ(refusal_of(parse, words_of("hrtc ball.spm" + faults)),
              "hrtc: --device-fault: at most 64 faults\n");
    // The rest depends on the processor.
    const std::string kernels =
        "hrtc: --kernels: 'sse' is not one of the kernels for this processor: portable";
    EXPECT_TRUE(refusal_of(parse, words_of("hrtc ball.spm --kernels sse")).starts_with(kernels));
}

TEST_F(HrtcOptions, of_a_file_are_refused_with_their_place_in_it)
{
    const std::pair<std::string, std::string> files[] = {
        {"buoyancy = 3", "--config: bad.toml:1: no option is called 'buoyancy'; see --help"},
        {"# Mine.\nrate = 1000\n  stifness = 300",
         "--config: bad.toml:3: no option is called 'stifness'; 'stiffness'?"},
        {"\n[loop]\nrate = 1000", "--config: bad.toml:2: begins a section; all are [[tool]]"},
        {"[tools]\nmotion = \"tap\"", "--config: bad.toml:1: begins a section; all are [[tool]]"},
        {"[[tool]]\nmotion = \"tap\"\n[[tool]]\nmotion = \"fly\"",
         "bad.toml:4: motion of tool 1: 'fly' is not script, free, approach, slide, tap, teleport, "
         "spin, tremor, turn, edge or peg, perhaps with :OBJECT behind it"},
        {"[[tool]]\n[[tool]]\n\n mass = [1, 0, 0, 2]",
         "bad.toml:4: mass of tool 1: '1,0,0,2' is not KG[,X,Y,Z]: Z is 2, not in -1 .. 1 m; "
         "1,0,0,0.002?"},
        {"[[tool]]\ndevice-limits = \"mass_kg=0\"",
         "bad.toml:2: device-limits of tool 0: device: mass_kg must be finite and > 0"},
        {"[[tool]]\nshpae = \"point\"",
         "--config: bad.toml:2: [[tool]]: 'shpae' is not shape, mass, fixture, edit, "
         "device, device-limits, device-frame or motion"},
        {"rate = 1000\n[[tool]]\nrate = 1000",
         "--config: bad.toml:3: [[tool]]: 'rate' is not shape, mass, fixture, edit, "
         "device, device-limits, device-frame or motion; other options go above the tables"},
        {"[[tool]]\nmass = 1\nshape = \"point\"\nmass = 2",
         "--config: bad.toml:2: [[tool]]: mass is given twice"},
        {"tools = 1\n[[tool]]\n[[tool]]", "[[tool]]: 2 given; at most 1 tool"},
        {"tool = [\"point\", \"ball\"]",
         "bad.toml:1: --tool of tool 1: '...' is not point, sphere:R, capsule:R,L, box:X,Y,Z[,R], "
         "hull:FILE[,R] or mesh:NAME[,R]"},
        {"splits: quickly", "--config: bad.toml:1: a line is KEY = VALUE"},
        {"root:$6$salt$c2VjcmV0:19000:0:99999:7:::", "--config: bad.toml:1: a line is KEY = VALUE"},
        {"c2VjcmV0Cg==", "--config: bad.toml:1: a line is KEY = VALUE"},
        {"config = \"other.toml\"", "config: This option is not allowed in a configuration file"},
        {"rate = \"1k\"",
         "bad.toml:1: --rate: '...' is not a whole number in 100 .. 10000; see --help"},
        {"\n\nrate = 99",
         "bad.toml:3: --rate: '...' is not a whole number in 100 .. 10000; see --help"},
        {"rate =", "bad.toml:1: --rate: '...' is not a whole number in 100 .. 10000; see --help"},
        {"rate = [1000, 2000]", "bad.toml:1: --rate: is given twice; see --help"},
        {"cpu = 1.5", "bad.toml:1: --cpu: '...' is not a whole number in 0 .. 1023; see --help"},
        {"pool-mib = 0",
         "bad.toml:1: --pool-mib: '...' is not a number in 0.25 .. 4096; see --help"},
        {"no-static = \"maybe\"",
         "bad.toml:1: --no-static: a value isn't what it takes; see --help"},
        {"# Mine.\nmodel = [",
         "bad.toml:2: --model: name '...' is not 1 to 63 bytes of letters, digits, . _ -"},
        {"model = \"ball.spm\"\ndevice = \"dhd:99\"",
         "bad.toml:2: --device: '...' is not dhd, or dhd:INDEX with 0 to 63"},
    };
    for (const auto& [text, said] : files)
    {
        folder_.write("bad.toml", text + "\n");
        SCOPED_TRACE(text);
        EXPECT_EQ(refusal_of(parse, words_of("hrtc --config bad.toml")), "hrtc: " + said + "\n");
    }
}

TEST_F(HrtcOptions, of_a_run_from_files_with_a_domain_show_it_to_viewers_but_not_in_virtual_time)
{
    folder_.write("ball.spm", "");
    const auto is_watched = [](const std::string& line) { return options_of(line).is_watched; };
    EXPECT_FALSE(is_watched("hrtc ball.spm"));
    EXPECT_TRUE(is_watched("hrtc ball.spm --domain 0"));
    EXPECT_TRUE(is_watched("hrtc --model ball"));
    testing::internal::CaptureStderr();
    EXPECT_FALSE(is_watched("hrtc ball.spm --domain 3 --virtual-time"));
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "note: --domain has no effect with --virtual-time\n");
}

/// What tells one tool from another.
std::string told(const Options& options)
{
    constexpr const char* kDevices[] = {"sim", "udp", "dhd", "replay", "plugin"};
    constexpr const char* kHands[] = {"script", "free", "approach", "slide", "tap"};
    std::ostringstream text;
    for (const ToolOptions& tool : options.tools)
    {
        text << (tool.shape ? tool.shape->words : "-") << ' ' << tool.load.mass_kg << ' '
             << (tool.fixture ? tool.fixture->words : "-") << ' '
             << kDevices[static_cast<std::size_t>(tool.device.kind)] << ' '
             << tool.device.limits.mass_kg << ' ' << tool.device.frame.translation_m[0] << ' '
             << kHands[static_cast<std::size_t>(tool.simulated.motion)] << tool.simulated.object
             << "; ";
    }
    return text.str();
}

TEST_F(HrtcOptions, of_tools_are_in_their_order_and_others_have_the_default)
{
    folder_.write("ball.spm", "");
    const std::string usual = "- 0 - sim 0.1 0 script; ";
    const std::pair<std::string, std::string> lines[] = {
        {"", usual},
        {"--tools 2", usual + usual},
        {"--tool point --tool sphere:0.1", "point 0 - sim 0.1 0 script; "
                                           "sphere:0.1 0 - sim 0.1 0 script; "},
        {"--tools 3 --motion free --motion tap:cup",
         "- 0 - sim 0.1 0 free; - 0 - sim 0.1 0 tapcup; " + usual},
        {"--motion none --motion tap", usual + "- 0 - sim 0.1 0 tap; "},
        {"--device sim --device dhd --device-limits mass_kg=3 --device-limits mass_kg=2",
         "- 0 - sim 3 0 script; - 0 - dhd 2 0 script; "},
        {"--device none --device udp --device-frame none --device-frame 7,0,0",
         usual + "- 0 - udp 0.1 7 script; "},
        {"--tool point --tool-mass none --tool-mass 2,1,0,0 --fixture none --fixture point:1,0,0",
         "point 0 - sim 0.1 0 script; - 2 point:1,0,0 sim 0.1 0 script; "},
    };
    for (const auto& [line, tools] : lines)
    {
        EXPECT_EQ(told(options_of("hrtc ball.spm " + line)), tools) << line;
        folder_.write("shown.toml", shown_by(parse, "hrtc ball.spm --print-config " + line));
        EXPECT_EQ(told(options_of("hrtc ball.spm --config shown.toml")), tools) << line;
    }
}

TEST_F(HrtcOptions, of_a_tool_in_a_file_yield_to_the_command_line_one_by_one)
{
    folder_.write("ball.spm", "");
    folder_.write("tools.toml",
                  "tools = 3\n[[tool]]\nshape = \"point\"\nmotion = \"tap\"\n\n[[tool]]\n"
                  "mass = [2, 1, 0, 0] # kg\nmotion = \"free\"\n");
    EXPECT_EQ(told(options_of("hrtc ball.spm --config tools.toml")),
              "point 0 - sim 0.1 0 tap; - 2 - sim 0.1 0 free; - 0 - sim 0.1 0 script; ");
    EXPECT_EQ(told(options_of("hrtc ball.spm --config tools.toml --motion none --tool none "
                              "--tool sphere:0.1 --tool-mass 3")),
              "- 3 - sim 0.1 0 script; sphere:0.1 2 - sim 0.1 0 free; - 0 - sim 0.1 0 script; ");
}

TEST_F(HrtcOptions, come_to_a_file_that_reads_as_they_do)
{
    folder_.write("good.toml",
                  "model = [\"ball\", \"torus\"]\nplace = [\"0,0,0\", \"1,0,0\"]\nrate = 2000\n"
                  "[[tool]]\n[[tool]]\ndevice = \"plugin:/a.so,'b' 3\"\n");
    const std::string all = shown_by(parse, "hrtc --config good.toml --rate 4000 --print-config");
    EXPECT_NE(all.find("\n\n[[tool]]\n\n[[tool]]\ndevice=\"plugin:/a.so,'b' 3\"\n"),
              std::string::npos)
        << all;
    EXPECT_NE(all.find("\nrate=4000\n"), std::string::npos) << "the command line goes first";
    EXPECT_NE(all.find("\nplace=[\"0,0,0\", \"1,0,0\"]\n"), std::string::npos) << all;
    folder_.write("all.toml", all);
    EXPECT_EQ(shown_by(parse, "hrtc --config all.toml --print-config"), all);
    const std::string secured =
        shown_by(parse, "hrtc --model ball --security keys --require-security --print-config");
    EXPECT_NE(secured.find("\nrequire-security=true\n"), std::string::npos) << secured;
    folder_.write("secured.toml", secured); // It says, too, that `plain` is false.
    EXPECT_EQ(shown_by(parse, "hrtc --config secured.toml --print-config"), secured);
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

using Names = std::vector<std::string>;

struct Given
{
    Names files{};
    Names models{};
    std::string scene{};
    Names tools{};
    std::optional<std::string> transport{};
};

struct Taken
{
    std::string fault;
    Names models;
    std::string scene;
    std::string transport;
};

Taken take(const Given& given)
{
    Options options;
    options.readers = file_readers();
    options.scene = given.scene;
    RawOptions raw;
    raw.files = given.files;
    raw.models = given.models;
    raw.of_tools[0] = given.tools;
    raw.transport = given.transport;
    EXPECT_EQ(set_tools(options, raw), "");
    const std::string fault = assign_files(options, raw, subcommand_names());
    return {fault, raw.models, options.scene, raw.transport.value_or("")};
}

TEST(FileChoice, tells_files_from_published_names)
{
    for (const char* file :
         {"cow.spm", "models/cow", "./cow", "cow.obj", "cow.STL", "a.gltf", "b.GLB"})
    {
        EXPECT_TRUE(is_file_name(file, file_readers())) << file;
    }
    for (const char* name : {"cow", "cow.v2", "cow@0123", "spm", "cow.spm@0123"})
    {
        EXPECT_FALSE(is_file_name(name, file_readers())) << name;
    }
}

TEST(FileChoice, takes_files_without_an_option_as_models_or_the_scene)
{
    const Taken models = take({.files = {"a.spm", "b/c.spm"}});
    EXPECT_EQ(models.fault, "");
    EXPECT_EQ(models.models, (Names{"a.spm", "b/c.spm"}));
    EXPECT_EQ(models.transport, "file");
    const Taken scene = take({.files = {"room.glb"}});
    EXPECT_EQ(scene.fault, "");
    EXPECT_EQ(scene.scene, "room.glb");
    EXPECT_EQ(scene.transport, "file");
    EXPECT_EQ(take({.models = {"cow"}}).transport, "dds");
    EXPECT_EQ(take({.scene = "room"}).transport, "dds");
    EXPECT_EQ(take({.models = {"a.spm"}, .tools = {"mesh:d,e.spm,0.001"}}).transport, "file");
}

TEST(FileChoice, refuses_a_mixture_unless_it_is_told_where_from)
{
    EXPECT_EQ(take({.files = {"a.spm"}, .models = {"cow"}}).fault,
              "--model: 'a.spm' is a file and 'cow' a published name; give all as files ('cow' as "
              "'cow.spm') or all as names");
    EXPECT_EQ(take({.models = {"cow"}, .tools = {"sphere:0.01", "mesh:e.spm"}}).fault,
              "--tool of tool 1: 'e.spm' is a file and 'cow' a published name; give all as files "
              "('cow' as 'cow.spm') or all as names");
    const Taken told = take({.models = {"a.spm", "cow"}, .transport = "dds"});
    EXPECT_EQ(told.fault, "");
    EXPECT_EQ(told.transport, "dds");
}

TEST(FileChoice, says_what_to_do_with_a_mesh_and_with_what_is_no_file)
{
    EXPECT_EQ(take({.files = {"cow.obj"}}).fault,
              "--model: 'cow.obj' is a mesh; build a model with: spm_build cow.obj -o MODEL.spm");
    EXPECT_EQ(take({.models = {"cow"}, .tools = {"mesh:cow.ply,0.01"}}).fault,
              "--tool: 'cow.ply' is a mesh; build a model with: spm_build cow.ply -o MODEL.spm");
    EXPECT_EQ(take({.files = {"touch"}}).fault,
              "'touch' is neither a command (doctor, deadline-test, load) nor a file of a model or "
              "scene (.spm, .gltf, .glb); use --model NAME for a published model");
    const std::string hash(32, '0');
    EXPECT_EQ(take({.models = {"cow.spm@" + hash}, .transport = "file"}).fault,
              "--model: 'cow.spm@" + hash +
                  "': only published models take a hash; give a file without a hash");
    EXPECT_EQ(take({.models = {"cow.spm@" + hash}}).transport, "dds");
    EXPECT_EQ(take({.files = {"a.glb", "b.glb"}}).fault,
              "'b.glb' is a second scene; only one scene is possible");
}

std::string hex(const udp::Tag& tag)
{
    std::string text;
    for (const std::byte byte : tag)
    {
        constexpr std::string_view kDigits = "0123456789abcdef";
        text += kDigits[std::to_integer<std::size_t>(byte >> 4)];
        text += kDigits[std::to_integer<std::size_t>(byte & std::byte{15})];
    }
    return text;
}

/// Tags by Python's hashlib.blake2b(text, digest_size=16, key=bytes(range(32))).
TEST(DeviceKey, makes_keyed_tags_as_others_do)
{
    const tactus::test::TemporaryFolder folder("device_key");
    const std::filesystem::path path = folder.path() / "key";
    std::ofstream(path) << "000102030405060708090A0b0c0d0e0f"
                           "101112131415161718191a1b1c1d1e1f\r\n";
    std::filesystem::permissions(path, std::filesystem::perms::owner_read);
    const auto sut = read_device_key(path.string());
    ASSERT_TRUE(sut) << sut.error().text;
    const std::string_view text = "TCTD and what follows";
    EXPECT_EQ(hex(sut.value()->tag_of(std::as_bytes(std::span(text)))),
              "110df4e37d314fdbf2fd07711387cd1d");
    EXPECT_EQ(hex(sut.value()->tag_of({})), "3daf97bce7888fd59773c66bf647459c");
}

} // namespace
} // namespace tactus::hrtc
