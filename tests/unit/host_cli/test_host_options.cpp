// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_build/options.hpp"
#include "host_tools/spm_inspect/options.hpp"
#include "host_tools/spm_publish/options.hpp"
#include "host_tools/spm_view/options.hpp"
#include "tests/unit/host_cli/command_lines.hpp"

#include <gtest/gtest.h>

#include <string>
#include <variant>

namespace tactus
{

namespace
{

using test::Parse;
using test::RefusedLine;
using test::RefusedValues;

/// A program's function of that name as its main() calls it.
template <typename Options>
Parse parse_with(const char* name,
                 std::variant<Options, int> (*parse_options)(CommandLine&, int, char**))
{
    return [=](int argc, char** argv)
    {
        CommandLine line(name, "");
        const auto parsed = parse_options(line, argc, argv);
        const int* code = std::get_if<int>(&parsed);
        return code == nullptr ? kExitDone : *code;
    };
}

const std::string kNameForm = " is not 1 to 63 characters of A-Z a-z 0-9 . _ -";

TEST(HostOptions, of_spm_build_are_refused_in_one_line)
{
    const RefusedLine lines[] = {
        {"spm_build", "spm_build: --output is required; see --help"},
        {"spm_build mesh.obj", "spm_build: --output is required; see --help"},
        {"spm_build mesh.obj -o", "spm_build: --output: a value is missing; see --help"},
        {"spm_build -o a.spm",
         "spm_build: give a mesh to read, or --shape and --faces; see --help"},
        {"spm_build mesh.obj -o a.spm --fast",
         "spm_build: --fast: no option is called so; see --help"},
        {"spm_build mesh.obj --units mm -o a.spm",
         "spm_build: --units: no option is called so; --unit?"},
        {"spm_build mesh.obj --scale 0.001 -o a.spm",
         "spm_build: --scale: no option is called so; --shape?"},
        {"spm_build mesh.obj mesh.obj -o a.spm",
         "spm_build: 'mesh.obj': nothing takes this word; see --help"},
        {"spm_build mesh.obj --unit mm --fit-diag 0.2 -o a.spm",
         "spm_build: --unit excludes --fit-diag; see --help"},
        {"spm_build mesh.obj --shape sphere --faces 1000 -o a.spm",
         "spm_build: IN excludes --shape; see --help"},
        {"spm_build --shape sphere -o a.spm", "spm_build: --shape requires --faces; see --help"},
        {"spm_build mesh.obj --faces 1000 -o a.spm",
         "spm_build: --faces requires --shape; see --help"},
        {"spm_build scene.gltf -o made --unit mm", "spm_build: --unit: a glTF scene is in metres"},
        {"spm_build scene.glb -o made --fit-diag 1",
         "spm_build: --fit-diag: a glTF scene is in metres"},
        {"spm_build scene.gltf -o made.spm",
         "spm_build: --output: a glTF scene needs a folder, which gets its models"},
    };
    const RefusedValues values[] = {
        {"spm_build mesh.obj -o",
         {"a.stl", "out/a.stl", "a"},
         "spm_build: --output: '{}' is the name of no model; one ends in .spm"},
        {"spm_build mesh.obj -o a.spm --unit",
         {"km", "furlong"},
         "spm_build: --unit: '{}' is not mm, cm, m or in; see --help"},
        {"spm_build mesh.obj -o a.spm --fit-diag",
         {"0", "-1", "nan", "wide"},
         "spm_build: --fit-diag: '{}' is not a number in 1e-06 .. 1000000; see --help"},
        {"spm_build mesh.obj -o a.spm --position-bits",
         {"15", "25", "32"},
         "spm_build: --position-bits: '{}' is not a number in 16 .. 24; see --help"},
        {"spm_build mesh.obj -o a.spm --base-faces",
         {"0", "1000000"},
         "spm_build: --base-faces: '{}' is not a number in 1 .. 16384; see --help"},
        {"spm_build mesh.obj -o a.spm --region-size",
         {"0"},
         "spm_build: --region-size: '{}' is not a number in 1e-12 .. 1000000; see --help"},
        {"spm_build mesh.obj -o a.spm --threads",
         {"0"},
         "spm_build: --threads: '{}' is not a number in 1 .. 1024; see --help"},
        {"spm_build -o a.spm --faces 1000 --shape",
         {"cube"},
         "spm_build: --shape: '{}' is not sphere, bumpy-sphere, torus, terrain, gear, peg, socket "
         "or plate; see --help"},
        {"spm_build -o a.spm --shape sphere --faces",
         {"3"},
         "spm_build: --faces: '{}' is not a number in 100 .. 16000000; see --help"},
    };
    const Parse parse = parse_with("spm_build", spm_build::parse_options);
    test::expect_refused(parse, lines);
    test::expect_refused(parse, values);
}

TEST(HostOptions, of_spm_inspect_are_refused_in_one_line)
{
    const RefusedLine lines[] = {
        {"spm_inspect", "spm_inspect: FILE is required; see --help"},
        {"spm_inspect ball.spm ---", "spm_inspect: ---: no option is called so; see --help"},
        {"spm_inspect ball.spm --distance points.txt",
         "spm_inspect: --distance: no option is called so; --distances?"},
        {"spm_inspect ball.spm ball.spm",
         "spm_inspect: 'ball.spm': nothing takes this word; see --help"},
        {"spm_inspect ball.spm --log-level loud",
         "spm_inspect: --log-level: 'loud' is not error, warning or info; see --help"},
        {"spm_inspect mesh.obj",
         "spm_inspect: FILE: 'mesh.obj' is a mesh; spm_build mesh.obj -o MODEL.spm makes a model "
         "of it"},
        {"spm_inspect ball.spm --extract", "spm_inspect: --extract requires --output; see --help"},
        {"spm_inspect ball.spm --extract --faces 100",
         "spm_inspect: --extract requires --output; see --help"},
        {"spm_inspect ball.spm --faces 100", "spm_inspect: --faces requires --extract; see --help"},
        {"spm_inspect ball.spm --error 1", "spm_inspect: --error requires --extract; see --help"},
        {"spm_inspect ball.spm --region sphere:0,0,0,1",
         "spm_inspect: --region requires --extract; see --help"},
        {"spm_inspect ball.spm --extract -o a.ply",
         "spm_inspect: --extract needs --faces, --error or --region; see --help"},
        {"spm_inspect ball.spm --extract -o a.ply --error 1 --faces 100",
         "spm_inspect: --faces excludes --error; see --help"},
        {"spm_inspect ball.spm --distances points.txt --extract --faces 100 -o a.ply",
         "spm_inspect: --distances and --extract: one at a time"},
        {"spm_inspect ball.spm --distances points.txt --regions",
         "spm_inspect: --regions excludes --distances; see --help"},
        {"spm_inspect ball.spm --distances points.txt --records",
         "spm_inspect: --records excludes --distances; see --help"},
    };
    const std::string extract = "spm_inspect ball.spm --extract -o a.ply ";
    const std::string region = "spm_inspect: --region: '{}': ";
    const std::string no_coordinate = " is not a number in -1000000000 .. 1000000000; see --help";
    const RefusedValues values[] = {
        {"spm_inspect ball.spm --extract --faces 100 -o",
         {"a.off", "out/stl"},
         "spm_inspect: --output: '{}' does not end in .ply, .obj or .stl; see --help"},
        {extract + "--faces",
         {"0", "many"},
         "spm_inspect: --faces: '{}' is not a number in 1 .. 4294967295; see --help"},
        {extract + "--error",
         {"-1", "nan", "1mm"},
         "spm_inspect: --error: '{}' is not a number in 0 .. 1000000; see --help"},
        {extract + "--region",
         {"ball:0,0,0,1"},
         region + "is neither sphere:x,y,z,r nor box:x0,y0,z0,x1,y1,z1; see --help"},
        {extract + "--region", {"sphere:0,0,0"}, region + "has 3 numbers and needs 4; see --help"},
        {extract + "--region",
         {"sphere:0,0,0,1,2"},
         region + "has 5 numbers and needs 4; see --help"},
        {extract + "--region", {"box:0,0,0,1,1"}, region + "has 5 numbers and needs 6; see --help"},
        {extract + "--region",
         {"sphere:0,0,0,0"},
         region + "radius 0 is not in 1e-09 .. 1000000000; see --help"},
        {extract + "--region",
         {"sphere:0,0,0,-1"},
         region + "radius -1 is not in 1e-09 .. 1000000000; see --help"},
        {extract + "--region", {"sphere:1e10,0,0,1"}, region + "'1e10'" + no_coordinate},
        {extract + "--region", {"sphere:0,0,nan,1"}, region + "'nan'" + no_coordinate},
        {extract + "--region", {"sphere:0,0,inf,1"}, region + "'inf'" + no_coordinate},
        {extract + "--region", {"sphere:0, 0,0,1"}, region + "' 0'" + no_coordinate},
        {extract + "--region", {"sphere:", "sphere:0,0,0,1,"}, region + "''" + no_coordinate},
        {extract + "--region",
         {"box:0,0,0,1,-1,1"},
         region + "y1 = -1 is not in y0 .. 1000000000, y0 being 0; see --help"},
    };
    const Parse parse = parse_with("spm_inspect", spm_inspect::parse_options);
    test::expect_refused(parse, lines);
    test::expect_refused(parse, values);
}

TEST(HostOptions, of_spm_publish_are_refused_in_one_line)
{
    const RefusedLine lines[] = {
        {"spm_publish", "spm_publish: FILE is required; see --help"},
        {"spm_publish ball.spm --fast", "spm_publish: --fast: no option is called so; see --help"},
        {"spm_publish ball.spm --rate 100", "spm_publish: --rate: no option is called so; --name?"},
        {"spm_publish ball.spm --pose path.txt",
         "spm_publish: --pose: no option is called so; --poses?"},
        {"spm_publish ball.spm --domain 1 --domain 2",
         "spm_publish: --domain: is given twice; see --help"},
        {"spm_publish ball.spm --duration 1m",
         "spm_publish: --seconds: '1m' is not a number in 0.1 .. 1000000000; see --help"},
        {"spm_publish ball.spm mesh.obj",
         "spm_publish: FILE: 'mesh.obj' is a mesh; spm_build mesh.obj -o MODEL.spm makes a model "
         "of it"},
        {"spm_publish ball.spm --name a --name b",
         "spm_publish: --name is given 2 times for 1 files"},
        {"spm_publish ball.spm other/ball.spm",
         "spm_publish: 'ball.spm' and 'other/ball.spm' would both be published as 'ball'; give "
         "them different names with --name"},
        {"spm_publish ball.spm other/ball.spm --name twice --name twice",
         "spm_publish: 'ball.spm' and 'other/ball.spm' would both be published as 'twice'; give "
         "them different names with --name"},
        {"spm_publish made/scene.gltf ball.spm",
         "spm_publish: FILE: a scene is served alone, its models under the names of their files"},
        {"spm_publish made/scene.gltf --name a",
         "spm_publish: --name: a scene is served alone, its models under the names of their files"},
        {"spm_publish ball.spm --poses-loop", "spm_publish: --poses-loop: needs --poses"},
        {"spm_publish ball.spm --poses-rate 100", "spm_publish: --poses-rate: needs --poses"},
    };
    const std::vector<std::string> no_names{
        "", "a b", "a/b", "a@b", "a\nb", "\x1b[31mred", std::string(64, 'n')};
    const RefusedValues values[] = {
        {"spm_publish",
         {"two words.spm"},
         "spm_publish: the stem of '{}', 'two words'" + kNameForm + "; give one with --name"},
        {"spm_publish ball.spm --name", no_names, "spm_publish: --name '{}'" + kNameForm},
        {"spm_publish ball.spm --scene", {"a b"}, "spm_publish: --scene: '{}'" + kNameForm},
        {"spm_publish", {"a b.gltf"}, "spm_publish: --scene: 'a b'" + kNameForm},
        {"spm_publish ball.spm --domain",
         {"233", "-1", "1.5"},
         "spm_publish: --domain: '{}' is not a whole number in 0 .. 232; see --help"},
        {"spm_publish ball.spm --seconds",
         {"0", "nan", "1m"},
         "spm_publish: --seconds: '{}' is not a number in 0.1 .. 1000000000; see --help"},
        {"spm_publish ball.spm --metrics",
         {"65536"},
         "spm_publish: --metrics: '{}' is not a whole number in 0 .. 65535; see --help"},
        {"spm_publish ball.spm --poses path.txt --poses-rate",
         {"5k"},
         "spm_publish: --poses-rate: '{}' is not a number in 1 .. 1000; see --help"},
    };
    const Parse parse = parse_with("spm_publish", spm_publish::parse_options);
    test::expect_refused(parse, lines);
    test::expect_refused(parse, values);
}

TEST(HostOptions, of_spm_view_are_refused_in_one_line)
{
    const RefusedLine lines[] = {
        {"spm_view --poort 80", "spm_view: --poort: no option is called so; --port?"},
        {"spm_view --port 65536",
         "spm_view: --port: '65536' is not a whole number in 0 .. 65535; see --help"},
        {"spm_view --domain 233",
         "spm_view: --domain: '233' is not a whole number in 0 .. 232; see --help"},
        {"spm_view --seconds 0",
         "spm_view: --seconds: '0' is not a number in 0.1 .. 1000000000; see --help"},
        {"spm_view --replay", "spm_view: --replay: a value is missing; see --help"},
        {"spm_view --replay a.rec --domain 3", "spm_view: --domain excludes --replay; see --help"},
        {"spm_view --replay a.rec --replay b.rec --replay c.rec",
         "spm_view: --replay: 3 recordings, two at most are compared"},
    };
    test::expect_refused(parse_with("spm_view", view::parse_options), lines);
}

TEST(HostOptions, are_explained_behind_the_name_of_the_program)
{
    const auto expect_explained =
        [](const Parse& parse, const std::string& name, const char* option)
    {
        EXPECT_TRUE(test::shown_by(parse, name + " --version").starts_with(name + " "));
        EXPECT_NE(test::shown_by(parse, name + " --help").find(option), std::string::npos) << name;
    };
    expect_explained(parse_with("spm_build", spm_build::parse_options), "spm_build", "--unit");
    expect_explained(parse_with("spm_inspect", spm_inspect::parse_options), "spm_inspect",
                     "--extract");
    expect_explained(parse_with("spm_publish", spm_publish::parse_options), "spm_publish",
                     "--domain");
    expect_explained(parse_with("spm_view", view::parse_options), "spm_view", "--replay");
}

} // namespace

} // namespace tactus
