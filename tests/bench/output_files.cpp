// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/output_files.hpp"

#include <span>
#include <utility>

namespace tactus::bench
{

namespace
{

Result<Done, Refusal> make(const std::string& path, std::optional<AtomicFile>& file)
{
    if (path.empty())
    {
        return Done{};
    }
    auto made = AtomicFile::create(path);
    if (!made)
    {
        return made.error();
    }
    file.emplace(std::move(made).value());
    return Done{};
}

Result<Done, Refusal> finish(std::optional<AtomicFile>& file, const std::string& text)
{
    const auto written = file->write(std::as_bytes(std::span(text)));
    return written ? file->commit() : written;
}

} // namespace

std::optional<std::string> OutputPaths::wrong_usage() const
{
    if (!csv.empty() && csv == json)
    {
        return "--csv: must be another file than --json";
    }
    if (!html.empty() && (html == json || html == csv))
    {
        return "--html: must be another file than --json and --csv";
    }
    return std::nullopt;
}

Result<OutputFiles, Refusal> OutputFiles::create(const OutputPaths& paths)
{
    OutputFiles files;
    for (const auto& [path, file] : {std::pair{&paths.json, &files.json_},
                                     {&paths.csv, &files.csv_},
                                     {&paths.html, &files.html_}})
    {
        if (auto made = make(*path, *file); !made)
        {
            return made.error();
        }
    }
    return files;
}

Result<Done, Refusal> OutputFiles::write(const Results& results, const RunFacts& facts)
{
    Result<Done, Refusal> done = Done{};
    if (json_)
    {
        done = finish(json_, to_json(results, facts));
    }
    if (done && csv_)
    {
        done = finish(csv_, to_csv(results.rows));
    }
    if (done && html_)
    {
        done = finish(html_, to_page(results, facts));
    }
    return done;
}

} // namespace tactus::bench
