from simconsole.profiles.world import CourseProfile
from simconsole.world.sumo.course_network import course_network


def test_lap_leads_from_node_to_node_and_back_to_the_start(urban: CourseProfile) -> None:
    network, lap = course_network(urban)
    edges = {edge.id: edge for edge in network.edges}
    for one, other in zip(lap, (*lap[1:], lap[0]), strict=True):
        assert edges[one].end == edges[other].start
    assert edges[lap[0]].start == "start"


def test_network_has_the_ingredients_of_the_course(urban: CourseProfile) -> None:
    network, _ = course_network(urban)
    kinds = [node.kind for node in network.nodes]
    assert kinds.count("traffic_light") == sum(spot.signalled for spot in urban.intersections)
    assert len(network.roundabouts) == len(urban.roundabouts)
    assert len(network.crossings) == len(urban.crossings) + 4 * kinds.count("traffic_light")
    names = [edge.id for edge in network.edges]
    assert len(set(names)) == len(names)
    assert all(f"-{name}" in names for name in names if name.startswith("road"))
