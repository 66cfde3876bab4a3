// Areas within contours, cut into bands between the heights of all corners and crossings, in which
// they are trapezoids.
#include <dspace/letters/FillContours.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace dspace {
namespace {

struct Edge {
  Eigen::Vector2i low;
  Eigen::Vector2i high;
  int turn; // 1 where the contour runs up, -1 where down

  double Slope() const {
    return double(this->high.x() - this->low.x()) / double(this->high.y() - this->low.y());
  }
  double ExactAt(double y) const { return this->low.x() + this->Slope() * (y - this->low.y()); }
  int At(int y) const {
    return y == this->high.y() ? this->high.x() : int(std::lround(this->ExactAt(y)));
  }
};

std::vector<Edge> EdgesOf(const std::vector<Contour>& contours) {
  std::vector<Edge> edges; // level ones bound no band
  for (const Contour& contour : contours) {
    for (std::size_t i = 0; i < contour.size(); ++i) {
      const Eigen::Vector2i& p = contour[i];
      const Eigen::Vector2i& q = contour[(i + 1) % contour.size()];
      if (p.y() < q.y()) {
        edges.push_back({p, q, 1});
      } else if (p.y() > q.y()) {
        edges.push_back({q, p, -1});
      }
    }
  }
  return edges;
}

std::set<int> HeightsOf(const std::vector<Edge>& edges) {
  std::set<int> heights;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Edge& a = edges[i];
    heights.insert({a.low.y(), a.high.y()});
    for (std::size_t k = 0; k < i; ++k) {
      const Edge& b = edges[k];
      const int bottom = std::max(a.low.y(), b.low.y());
      const int top = std::min(a.high.y(), b.high.y());
      if (bottom < top) {
        const double below = a.ExactAt(bottom) - b.ExactAt(bottom);
        const double above = a.ExactAt(top) - b.ExactAt(top);
        if (below * above < 0) { // they cross
          heights.insert(int(std::lround(bottom + (top - bottom) * below / (below - above))));
        }
      }
    }
  }
  return heights;
}

// Between two heights, from side to side at the bottom and at the top.
struct Trapezoid {
  int bottom, top;
  std::array<int, 2> below, above;
};

std::vector<Trapezoid> TrapezoidsOf(const std::vector<Edge>& edges) {
  std::vector<Trapezoid> trapezoids;
  const std::set<int> heights = HeightsOf(edges);
  for (auto at = heights.begin(); at != heights.end() && std::next(at) != heights.end(); ++at) {
    const int bottom = *at;
    const int top = *std::next(at);
    std::vector<const Edge*> here;
    for (const Edge& edge : edges) {
      if (edge.low.y() <= bottom && edge.high.y() >= top) {
        here.push_back(&edge);
      }
    }
    const double middle = (double(bottom) + double(top)) / 2;
    std::sort(here.begin(), here.end(), [&](const Edge* a, const Edge* b) {
      return a->ExactAt(middle) < b->ExactAt(middle);
    });
    int turns = 0;
    const Edge* left = nullptr;
    for (const Edge* edge : here) {
      left = turns == 0 ? edge : left;
      turns += edge->turn;
      if (turns == 0) {
        trapezoids.push_back(
            {bottom, top, {left->At(bottom), edge->At(bottom)}, {left->At(top), edge->At(top)}});
      }
    }
  }
  return trapezoids;
}

} // namespace

FlatArea FillContours(const std::vector<Contour>& contours) {
  const std::vector<Trapezoid> trapezoids = TrapezoidsOf(EdgesOf(contours));
  // Sides are shared corner by corner, so that no gap opens between them when they are drawn.
  std::map<int, std::map<int, std::uint32_t>> corners; // by height, then by x
  for (const Trapezoid& t : trapezoids) {
    for (const int side : {0, 1}) {
      corners[t.bottom][t.below[side]] = 0;
      corners[t.top][t.above[side]] = 0;
    }
  }
  FlatArea area;
  for (auto& [y, line] : corners) {
    for (auto& [x, index] : line) {
      index = static_cast<std::uint32_t>(area.points.size());
      area.points.emplace_back(x, y);
    }
  }
  for (const Trapezoid& t : trapezoids) {
    const auto& bottom = corners[t.bottom];
    const auto& top = corners[t.top];
    auto b = bottom.find(std::min(t.below[0], t.below[1]));
    auto a = top.find(std::min(t.above[0], t.above[1]));
    const auto lastB = bottom.find(std::max(t.below[0], t.below[1]));
    const auto lastA = top.find(std::max(t.above[0], t.above[1]));
    while (b != lastB || a != lastA) { // a strip of triangles from the left to the right
      const bool below =
          a == lastA || (b != lastB && std::next(b)->first + 0LL <= std::next(a)->first);
      const auto next = below ? std::next(b) : std::next(a);
      area.triangles.insert(area.triangles.end(), {b->second, next->second, a->second});
      (below ? b : a) = next;
    }
  }
  return area;
}

} // namespace dspace
