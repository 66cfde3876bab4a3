#include <dspace/sky/KernelContents.h>

#include <charconv>
#include <functional>
#include <optional>
#include <set>

#include <dspace/Checks.h>
#include <dspace/kernels/KernelPool.h>
#include <dspace/kernels/LeapSecondKernel.h>
#include <dspace/time/DayText.h>

namespace dspace {
namespace {

// The id in a name as "BODY499_RADII" with its prefix and suffix; none: another name.
std::optional<int> IdIn(const std::string& name, const std::string& prefix,
                        const std::string& suffix) {
  if (name.size() <= prefix.size() + suffix.size() || name.compare(0, prefix.size(), prefix) != 0 ||
      name.compare(name.size() - suffix.size(), suffix.size(), suffix) != 0) {
    return std::nullopt;
  }
  const char* begin = name.data() + prefix.size();
  const char* end = name.data() + name.size() - suffix.size();
  int id = 0;
  const auto [stop, error] = std::from_chars(begin, end, id);
  return error == std::errc() && stop == end ? std::optional<int>(id) : std::nullopt;
}

std::string Listed(const std::set<int>& ids, const std::function<std::string(int)>& text) {
  std::string out;
  for (const int id : ids) {
    out += (out.empty() ? "" : ", ") + text(id);
  }
  return out;
}

} // namespace

KernelContent ContentOf(const TextKernel& kernel, const BodyNames& names) {
  KernelContent out;
  out.file = kernel.Name();
  out.kind = kernel.Kind();
  std::set<std::string> variables;
  std::set<int> radii, turns, masses, instruments, clocks;
  std::size_t bodies = 0, kernels = 0;
  const auto add = [](std::set<int>& to, const std::optional<int>& id) {
    if (id) {
      to.insert(*id);
    }
  };
  for (const KernelAssignment& each : kernel.Assignments()) {
    variables.insert(each.name);
    add(radii, IdIn(each.name, "BODY", "_RADII"));
    add(turns, IdIn(each.name, "BODY", "_PM"));
    add(masses, IdIn(each.name, "BODY", "_GM"));
    add(instruments, IdIn(each.name, "INS", "_BORESIGHT"));
    add(clocks, IdIn(each.name, "SCLK_DATA_TYPE_", ""));
    bodies += each.name == "NAIF_BODY_NAME" ? each.texts.size() : 0;
    kernels += each.name == "KERNELS_TO_LOAD" ? each.texts.size() : 0;
  }
  out.variables = int(variables.size());
  const auto name = [&](int id) { return names.NameOf(id); };
  const auto number = [](int id) { return std::to_string(id); };
  const auto list = [&](const char* what, const std::set<int>& ids, const auto& text) {
    if (!ids.empty()) {
      out.items.push_back(what + Listed(ids, text));
    }
  };
  if (kernels > 0) {
    out.items.push_back("names " + std::to_string(kernels) + " kernels to load");
  }
  KernelPool pool;
  pool.Add(kernel);
  if (HasLeapSeconds(pool)) {
    try {
      const LeapSeconds leaps = TimeScalesOf(pool).GetLeapSeconds();
      const LeapSeconds::Step& last = leaps.Steps().back();
      out.items.push_back("leap seconds up to that of " + DayText(last.mjd) +
                          " (TAI - UTC = " + NumberText(last.taiMinusUtc) + " s)");
    } catch (const Error&) {
      out.items.emplace_back("leap seconds"); // another file has the rest of them
    }
  }
  list("radii of ", radii, name);
  list("orientation of ", turns, name);
  list("GM of ", masses, name);
  if (bodies > 0) {
    out.items.push_back("names of " + std::to_string(bodies) + " bodies");
  }
  list("fields of view of instruments ", instruments, number);
  list("clocks ", clocks, [](int id) { return std::to_string(-id); }); // named without the sign
  return out;
}

KernelContent ContentOf(const EarthOrientation& earth) {
  KernelContent out;
  out.file = earth.Name();
  out.kind = "EOP";
  out.items.push_back("UT1 and polar motion from " + DayText(int(earth.FirstMjd())) + " to " +
                      DayText(int(earth.LastMjd())));
  if (earth.FirstPredicted()) {
    out.items.push_back("predicted from " + DayText(int(*earth.FirstPredicted())));
  }
  return out;
}

} // namespace dspace
