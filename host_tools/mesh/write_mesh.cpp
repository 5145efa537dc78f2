// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/write_mesh.hpp"

#include "host_tools/mesh/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
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

/// Gathers values into large writes and keeps the first error.
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

    Result<Done, FileError> finish()
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
    Result<Done, FileError> result_{Done{}};
};

} // namespace

Result<Done, MeshError> write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh)
{
    if (path.extension() != ".ply")
    {
        return MeshError{path.string() + ": meshes are written as PLY; the name must end in .ply"};
    }
    auto file = AtomicFile::create(path);
    if (!file)
    {
        return MeshError{file.error().text};
    }
    const bool as_float = are_exact_as_float(mesh.positions);
    Writer writer(file.value());
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
    const auto done = writer.finish();
    if (!done)
    {
        return MeshError{done.error().text};
    }
    return Done{};
}

} // namespace tactus
