// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
/// make_corpus FOLDER: writes the seeds of every fuzz target anew, from generated shapes and with
/// this build's writers. The same build gives the same bytes.
#include "host_tools/mesh/write_mesh.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "tests/fuzz/law.hpp"
#include "tests/shared/test_model.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <string_view>

namespace tactus::fuzz
{

namespace
{

namespace fs = std::filesystem;

/// One bit from not being finite.
constexpr float kHugeFloat = 3e38F;

void write(const fs::path& path, const std::string& content)
{
    fs::create_directories(path.parent_path());
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file << content;
    require(file.good(), "the seed can be written");
}

TriangleMesh shape(Shape kind, std::uint32_t faces)
{
    return make_shape(kind, faces).value();
}

/// Models of one chunk, of two with a border, and without records. No extension: what ends in .spm
/// is a product and not kept.
void write_models(const fs::path& folder)
{
    fs::create_directories(folder);
    const auto add = [&](const char* name, const TriangleMesh& mesh, std::uint32_t base_faces)
    {
        fs::copy_file(test::test_model(name, mesh, base_faces).path, folder / name,
                      fs::copy_options::overwrite_existing);
    };
    add("one_chunk", shape(Shape::sphere, 100), 16);
    add("two_chunks", shape(Shape::terrain, 200), 24);
    add("no_records", make_thin_plate(2, 0.01).value(), 500);
}

/// Scripts of fuzz_chunk_link.cpp.
class ScriptWriter
{
public:
    explicit ScriptWriter(std::uint32_t lump) { byte(lump); }

    ScriptWriter& edits(std::uint32_t count) { return byte(count); }
    ScriptWriter& edit(std::uint32_t chunk, std::uint32_t kind, std::uint32_t place,
                       std::uint32_t value)
    {
        return byte(chunk).byte(kind).byte(place & 255U).byte(place >> 8U).byte(value);
    }
    ScriptWriter& bring(std::initializer_list<std::uint32_t> chunks) { return steps(0, chunks); }
    ScriptWriter& take_away(std::initializer_list<std::uint32_t> chunks)
    {
        return steps(2, chunks);
    }
    ScriptWriter& take_updates(std::uint32_t count) { return steps(3, {count}); }
    [[nodiscard]] const std::string& text() const { return text_; }

private:
    ScriptWriter& byte(std::uint32_t value)
    {
        text_ += static_cast<char>(value);
        return *this;
    }
    ScriptWriter& steps(std::uint32_t kind, std::initializer_list<std::uint32_t> operands)
    {
        for (const std::uint32_t operand : operands)
        {
            byte(4 * operand + kind);
        }
        return *this;
    }

    std::string text_;
};

void write_scripts(const fs::path& folder)
{
    write(folder / "in_order",
          ScriptWriter(0).edits(0).bring({0, 1, 2, 3, 4, 5}).take_updates(9).text());
    write(folder / "backwards",
          ScriptWriter(1).edits(0).bring({5, 4, 3, 2, 1}).take_updates(2).bring({0}).text());
    write(folder / "come_and_go", ScriptWriter(0)
                                      .edits(0)
                                      .bring({0, 1, 2})
                                      .take_away({0})
                                      .bring({4, 3})
                                      .take_updates(3)
                                      .take_away({2, 1})
                                      .bring({0, 2, 1})
                                      .take_away({4})
                                      .text());
    // The kinds are those of Edit in fuzz_chunk_link.cpp: four of bytes, seven of parsed records.
    write(folder / "changed_bytes", ScriptWriter(0)
                                        .edits(4)
                                        .edit(1, 0, 40, 7)
                                        .edit(2, 1, 300, 3)
                                        .edit(3, 2, 100, 0)
                                        .edit(4, 3, 9, 1)
                                        .bring({0, 1, 2, 3, 4})
                                        .text());
    // Fans as long as they may be, one of them round a whole vertex.
    write(folder / "changed_fans", ScriptWriter(0)
                                       .edits(7)
                                       .edit(2, 6, 33, 5)
                                       .edit(4, 6, 26, 25)
                                       .edit(1, 6, 31, 20)
                                       .edit(6, 6, 35, 20)
                                       .edit(3, 6, 11, 30)
                                       .edit(5, 6, 39, 25)
                                       .edit(4, 6, 8, 12)
                                       .bring({0, 1, 2, 3, 4, 5})
                                       .text());
    write(folder / "changed_records", ScriptWriter(1)
                                          .edits(7)
                                          .edit(1, 4, 3 + 64 * 70, 2)
                                          .edit(1, 5, 20, 10)
                                          .edit(2, 6, 9, 45)
                                          .edit(2, 7, 30 + 64 * 70, 2)
                                          .edit(0, 8, 12 + 64 * 515, 2)
                                          .edit(0, 9, 30, 10)
                                          .edit(3, 10, 5 + 64 * 511, 21)
                                          .bring({3, 1, 0})
                                          .take_away({0})
                                          .bring({2, 0})
                                          .take_away({1, 2})
                                          .bring({2, 1})
                                          .text());
}

/// One line for each vertex and face; `first` is the number of the first vertex.
std::string text_of(const TriangleMesh& mesh, const char* vertex, const char* face,
                    std::uint32_t first)
{
    std::string text;
    for (const auto& [x, y, z] : mesh.positions)
    {
        text += fmt::format("{}{:.4} {:.4} {:.4}\n", vertex, x, y, z);
    }
    for (const auto& [a, b, c] : mesh.faces)
    {
        text += fmt::format("{}{} {} {}\n", face, a + first, b + first, c + first);
    }
    return text;
}

std::string bytes_of(float value, bool big_endian)
{
    auto bits = std::bit_cast<std::uint32_t>(value);
    bits = big_endian ? __builtin_bswap32(bits) : bits;
    std::string bytes(sizeof(bits), '\0');
    std::memcpy(bytes.data(), &bits, sizeof(bits));
    return bytes;
}

void write_plys(const fs::path& folder, const TriangleMesh& mesh)
{
    fs::create_directories(folder);
    require(write_mesh(folder / "little_endian.ply", mesh).has_value(), "a PLY can be written");
    write(folder / "text.ply",
          fmt::format("ply\nformat ascii 1.0\ncomment a comment\nelement vertex {}\n"
                      "property double x\nproperty double y\nproperty double z\n"
                      "element face {}\nproperty list uchar int vertex_indices\nend_header\n{}",
                      mesh.positions.size(), mesh.faces.size(), text_of(mesh, "", "3 ", 0)));
    std::string strip = "ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty float x\n"
                        "property float y\nproperty float z\nproperty uchar red\n"
                        "element extra 2\nproperty list ushort short numbers\n"
                        "element tristrips 1\nproperty list uchar char vertex_indices\n"
                        "end_header\n";
    for (std::uint32_t corner = 0; corner < 4; ++corner)
    {
        strip += bytes_of(static_cast<float>(corner % 2), true) +
                 bytes_of(static_cast<float>(corner / 2), true) +
                 bytes_of(corner == 3 ? kHugeFloat : 0.5F, true) + '\x7F';
    }
    strip += std::string("\0\0\0\1\0\7", 6) + std::string("\6\0\1\2\3\xFF\0", 7);
    write(folder / "big_endian_strip.ply", strip);
}

void write_objs(const fs::path& folder, const TriangleMesh& mesh)
{
    write(folder / "shape.obj", "# a shape\no shape\n" + text_of(mesh, "v ", "f ", 1));
    write(folder / "huge.obj", "v 0 0 0\nv 1e308 0 0\nv 0 1e+300 0\nf 1 2 3\n");
    write(folder / "polygons.obj",
          "v 0 0 0\nv 1 0 0 1.0\nv 1 1 0\nv 0 1 +1e-3\nvn 0 0 1\nvt 0 0\ng a\nusemtl b\n"
          "f 1/1/1 2//1 3/1 \\\n 4\nf -4 -3 -1 # a comment\np 1\nl 1 2\n");
}

void write_stls(const fs::path& folder, const TriangleMesh& mesh)
{
    std::string text = "solid shape\n";
    std::string binary(80, ' ');
    const auto count = static_cast<std::uint32_t>(mesh.faces.size());
    binary += bytes_of(std::bit_cast<float>(count), false);
    for (const auto& face : mesh.faces)
    {
        text += "facet normal 0 0 0\nouter loop\n";
        binary += std::string(12, '\0');
        for (const std::uint32_t corner : face)
        {
            const auto& [x, y, z] = mesh.positions[corner];
            text += fmt::format("vertex {:.4} {:.4} {:.4}\n", x, y, z);
            for (const double c : {x, y, z})
            {
                binary += bytes_of(static_cast<float>(c), false);
            }
        }
        text += "endloop\nendfacet\n";
        binary += std::string(2, '\0');
    }
    write(folder / "text.stl", text + "endsolid shape\n");
    write(folder / "binary.stl", binary);
    const std::string huge = bytes_of(kHugeFloat, false);
    write(folder / "huge.stl", std::string(80, ' ') + std::string("\1\0\0\0", 4) +
                                   std::string(20, '\0') + huge + huge + std::string(22, '\0'));
}

void write_offs(const fs::path& folder, const TriangleMesh& mesh)
{
    write(folder / "shape.off", fmt::format("OFF\n# a shape\n{} {} 0\n{}", mesh.positions.size(),
                                            mesh.faces.size(), text_of(mesh, "", "3 ", 0)));
    write(folder / "huge.off", "OFF\n3 1 0\n0 0 0\n1e308 0 0\n0 -1e308 0\n3 0 1 2\n");
    write(folder / "colours.off", "COFF 4 2 0\n0 0 0 255 0 0 255\n1 0 0 1 1 1 1\n1 1 0 # bare\n"
                                  "0 1 1e-3 0 0 0 0\n4 0 1 2 3 0.5 0.5 0.5\n3 0 2 3\n");
}

std::string base64_of(const std::string& bytes)
{
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    require(bytes.size() % 3 == 0, "seeds need no padding");
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3)
    {
        const auto byte = [&](std::size_t k)
        { return std::uint32_t{static_cast<unsigned char>(bytes[i + k])}; };
        const std::uint32_t bits = (byte(0) << 16U) | (byte(1) << 8U) | byte(2);
        for (const unsigned shift : {18U, 12U, 6U, 0U})
        {
            text += kDigits[(bits >> shift) & 63U];
        }
    }
    return text;
}

/// 48 bytes of positions, 12 of indices, 12 of a sparse position, 2 of its index, 4 of nothing.
std::string tetrahedron_bytes()
{
    std::string bytes;
    for (const float c : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F})
    {
        bytes += bytes_of(c, false);
    }
    bytes += std::string("\0\2\1\0\1\3\1\2\3\2\0\3", 12);
    bytes += bytes_of(0.5F, false) + bytes_of(0.5F, false) + bytes_of(2.F, false);
    return bytes + std::string("\3\0\0\0\0\0", 6);
}

/// Two nodes, one below the other and mirrored, show a mesh of triangles and a strip.
std::string scene_json(const std::string& buffer)
{
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)"
           R"({"name":"a","mesh":0,"children":[1],"translation":[1,0,2]},)"
           R"({"name":"a","mesh":0,"scale":[-2,2,2],"rotation":[0,0.6,0,0.8],)"
           R"("extras":{"tactus":{"material":{"stiffness":9,"static":1}}}}],)"
           R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1},)"
           R"({"attributes":{"POSITION":0},"mode":5}]}],"accessors":[)"
           R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","sparse":{"count":1,)"
           R"("indices":{"bufferView":0,"byteOffset":72,"componentType":5121},)"
           R"("values":{"bufferView":0,"byteOffset":60}}},)"
           R"({"bufferView":0,"byteOffset":48,"componentType":5121,"count":12,"type":"SCALAR"}],)"
           R"("bufferViews":[{"buffer":0,"byteLength":78}],"buffers":[{)" +
           buffer + R"("byteLength":78}]})";
}

void write_scenes(const fs::path& folder)
{
    const std::string binary = tetrahedron_bytes();
    write(folder / "embedded.gltf",
          scene_json("\"uri\":\"data:;base64," + base64_of(binary) + "\","));
    std::string json = scene_json("");
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const auto u32 = [](std::size_t value)
    { return bytes_of(std::bit_cast<float>(static_cast<std::uint32_t>(value)), false); };
    write(folder / "binary.glb", "glTF" + u32(2) + u32(12 + 8 + json.size() + 8 + 80) +
                                     u32(json.size()) + "JSON" + json + u32(80) +
                                     std::string("BIN\0", 4) + binary + std::string(2, '\0'));
    write(folder / "models.gltf",
          R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0,1]}],"nodes":[{"matrix":)"
          R"([0,2,0,0,-2,0,0,0,0,0,2,0,5,6,7,1],"extras":{"tactus":{"model":"a.spm"}}},)"
          R"({"mesh":0,"extras":{"tactus":{"touch":false}}}],"meshes":[{}]})");
}

} // namespace

} // namespace tactus::fuzz

int main(int argc, char** argv)
{
    if (argc != 2)
    {
        std::fputs("usage: make_corpus FOLDER\n", stderr);
        return 3;
    }
    using namespace tactus;
    const std::filesystem::path folder = argv[1];
    const TriangleMesh lump = make_uv_sphere(3, 4).value();
    fuzz::write_models(folder / "spm_reader");
    fuzz::write_scripts(folder / "chunk_link");
    fuzz::write_plys(folder / "read_ply", lump);
    fuzz::write_objs(folder / "read_obj", lump);
    fuzz::write_stls(folder / "read_stl", lump);
    fuzz::write_offs(folder / "read_off", lump);
    fuzz::write_scenes(folder / "read_scene");
    return 0;
}
