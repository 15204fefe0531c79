#include "quads/matching.h"

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/max_cardinality_matching.hpp>

#include <algorithm>
#include <numeric>

namespace cagewright {

std::vector<std::size_t> most_pairs(std::size_t nodes, std::span<const PossiblePair> possible) {
  using Graph = boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS>;
  using Node = boost::graph_traits<Graph>::vertex_descriptor;
  std::vector<std::size_t> order(possible.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return possible[a].cost < possible[b].cost;
  });
  Graph graph(nodes);
  const Node none = boost::graph_traits<Graph>::null_vertex();
  std::vector<Node> mate(nodes, none);
  for (const std::size_t i : order) {
    const auto [a, b, cost] = possible[i];
    boost::add_edge(a, b, graph);
    if (mate[a] == none && mate[b] == none) {
      mate[a] = b;
      mate[b] = a;
    }
  }
  const auto number = boost::get(boost::vertex_index, graph);
  boost::edmonds_augmenting_path_finder<Graph, Node*, decltype(number)> finder(graph, mate.data(),
                                                                               number);
  while (finder.augment_matching()) {
  }
  finder.get_current_matching(mate.data());
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < possible.size(); ++i) {
    if (mate[possible[i].first] == possible[i].second) {
      chosen.push_back(i);
    }
  }
  return chosen;
}

} // namespace cagewright
