// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/write_mesh.hpp"

#include "rt_core/math/vec3.hpp"
#include "transport/base/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tactus
{

namespace
{

static_assert(std::endian::native == std::endian::little, "values are written as they lie");

bool is_exact_as_float(double value)
{
    constexpr double kLargest = static_cast<double>(std::numeric_limits<float>::max());
    return value >= -kLargest && value <= kLargest &&
           static_cast<double>(static_cast<float>(value)) == value;
}

bool are_exact_as_float(const std::vector<std::array<double, 3>>& positions)
{
    return std::all_of(positions.begin(), positions.end(),
                       [](const auto& p)
                       { return std::all_of(p.begin(), p.end(), is_exact_as_float); });
}

std::string header_for(const TriangleMesh& mesh, bool as_float)
{
    const char* type = as_float ? "float" : "double";
    return fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
                       "property {} x\nproperty {} y\nproperty {} z\nelement face {}\n"
                       "property list uchar uint vertex_indices\nend_header\n",
                       mesh.positions.size(), type, type, type, mesh.faces.size());
}

/// Collects values into large writes and keeps the first error.
class Writer
{
public:
    explicit Writer(AtomicFile& file) : file_(file) {}

    template <typename T>
    void put(const T& value)
    {
        const auto bytes = std::as_bytes(std::span(&value, 1));
        buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
        if (buffer_.size() >= kFlushBytes)
        {
            flush();
        }
    }

    void put_text(const std::string& text)
    {
        for (const char c : text)
        {
            put(c);
        }
    }

    Result<Done, Refusal> finish()
    {
        flush();
        return result_ ? file_.commit() : result_;
    }

private:
    static constexpr std::size_t kFlushBytes = std::size_t{1} << 20U;

    void flush()
    {
        if (result_)
        {
            result_ = file_.write(buffer_);
        }
        buffer_.clear();
    }

    AtomicFile& file_;
    std::vector<std::byte> buffer_;
    Result<Done, Refusal> result_{Done{}};
};

void put_ply(Writer& writer, const TriangleMesh& mesh)
{
    const bool as_float = are_exact_as_float(mesh.positions);
    writer.put_text(header_for(mesh, as_float));
    for (const auto& position : mesh.positions)
    {
        for (const double coordinate : position)
        {
            as_float ? writer.put(static_cast<float>(coordinate)) : writer.put(coordinate);
        }
    }
    for (const auto& face : mesh.faces)
    {
        writer.put(std::uint8_t{3});
        writer.put(face);
    }
}

void put_obj(Writer& writer, const TriangleMesh& mesh)
{
    for (const auto& [x, y, z] : mesh.positions)
    {
        writer.put_text(fmt::format("v {} {} {}\n", x, y, z));
    }
    for (const auto& [a, b, c] :
         mesh.faces) // Counted from 1; in 64 bits, since the last may be 2^32.
    {
        writer.put_text(fmt::format("f {} {} {}\n", std::uint64_t{a} + 1, std::uint64_t{b} + 1,
                                    std::uint64_t{c} + 1));
    }
}

using FloatPosition = std::array<float, 3>;

FloatPosition as_floats(const std::array<double, 3>& position)
{
    return {static_cast<float>(position[0]), static_cast<float>(position[1]),
            static_cast<float>(position[2])};
}

template <typename Position>
std::size_t count_different(std::vector<Position> positions)
{
    std::sort(positions.begin(), positions.end());
    return static_cast<std::size_t>(std::unique(positions.begin(), positions.end()) -
                                    positions.begin());
}

/// True if no two vertices become one as floats. STL identifies vertices by position, so that would
/// close or fold the mesh.
bool stay_apart_as_floats(const std::vector<std::array<double, 3>>& positions)
{
    std::vector<FloatPosition> rounded(positions.size());
    std::transform(positions.begin(), positions.end(), rounded.begin(), as_floats);
    const bool are_finite = std::all_of(
        rounded.begin(), rounded.end(),
        [](const FloatPosition& p)
        { return std::all_of(p.begin(), p.end(), [](float c) { return c - c == 0.0F; }); });
    return are_finite && count_different(std::move(rounded)) == count_different(positions);
}

/// Unit normal for counter-clockwise corners; zero for a face without area.
FloatPosition normal_of(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& face)
{
    const auto at = [&](std::size_t corner)
    {
        const auto& p = mesh.positions[face[corner]];
        return Vec3(p[0], p[1], p[2]);
    };
    const Vec3 normal = (at(1) - at(0)).cross(at(2) - at(0)).stableNormalized();
    return as_floats({normal.x(), normal.y(), normal.z()});
}

void put_stl(Writer& writer, const TriangleMesh& mesh)
{
    std::string header = "binary STL"; // Must not begin with "solid", as text does.
    header.resize(80, ' ');
    writer.put_text(header);
    writer.put(static_cast<std::uint32_t>(mesh.faces.size()));
    for (const auto& face : mesh.faces)
    {
        writer.put(normal_of(mesh, face));
        for (const std::uint32_t corner : face)
        {
            writer.put(as_floats(mesh.positions[corner]));
        }
        writer.put(std::uint16_t{0});
    }
}

using PutMesh = void (*)(Writer&, const TriangleMesh&);

/// Writer for a path's extension, in either case of letters; null for others.
PutMesh writer_for(const std::filesystem::path& path)
{
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return extension == ".ply"   ? put_ply
           : extension == ".obj" ? put_obj
           : extension == ".stl" ? put_stl
                                 : nullptr;
}

} // namespace

bool has_mesh_extension(const std::filesystem::path& path)
{
    return writer_for(path) != nullptr;
}

Result<Done, Refusal> write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh)
{
    const PutMesh put_mesh = writer_for(path);
    if (put_mesh == nullptr)
    {
        return Refusal{path.string() + ": the name must end in .ply, .obj or .stl"};
    }
    if (put_mesh == put_stl && !stay_apart_as_floats(mesh.positions))
    {
        return Refusal{path.string() + ": STL's 32-bit coordinates can't keep all vertices apart "
                                       "so far from the origin; write .ply or .obj"};
    }
    auto file = AtomicFile::create(path);
    if (!file)
    {
        return file.error();
    }
    Writer writer(file.value());
    put_mesh(writer, mesh);
    const auto done = writer.finish();
    if (!done)
    {
        return done.error();
    }
    return Done{};
}

} // namespace tactus
