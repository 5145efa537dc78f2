// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/machine.hpp"

#include <array>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <sys/utsname.h>
#include <thread>

namespace tactus::hrtc
{

namespace
{

std::string processor_name()
{
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
    {
        const std::size_t colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos)
        {
            return line.substr(colon + 2);
        }
    }
    return "unknown";
}

std::string preemption_model(const std::string& version)
{
    for (const char* model : {"PREEMPT_RT", "PREEMPT_DYNAMIC", "PREEMPT"})
    {
        if (version.find(model) != std::string::npos)
        {
            return model;
        }
    }
    return "none stated";
}

std::string date_utc()
{
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    std::array<char, 32> text{};
    if (gmtime_r(&now, &parts) == nullptr ||
        std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts) == 0)
    {
        return "unknown";
    }
    return text.data();
}

} // namespace

Machine describe_machine()
{
    Machine machine;
    utsname names{};
    if (uname(&names) == 0)
    {
        machine.kernel = std::string(names.sysname) + " " + names.release + " " + names.machine;
        machine.preemption = preemption_model(names.version);
    }
    machine.processor = processor_name();
    machine.processors = std::thread::hardware_concurrency();
    std::array<double, 1> load{};
    machine.load_average = getloadavg(load.data(), 1) == 1 ? load[0] : 0.0;
    machine.date_utc = date_utc();
    return machine;
}

std::uint32_t silent_periods(const Machine& machine)
{
    return machine.preemption == "PREEMPT_RT" ? 3 : 10;
}

} // namespace tactus::hrtc
