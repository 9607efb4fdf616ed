from xml.etree import ElementTree

from simconsole.world.sumo.plain_xml import PlainCrossing, PlainEdge, PlainNetwork, PlainNode


def test_files_hold_what_netconvert_needs() -> None:
    edge = PlainEdge(
        id='a"b', start="n", end="m", line=((0.0, 0.0), (5.0, 1.0, 2.5)), limit_mps=13.9, width_m=3.5, sidewalk_m=2.0
    )
    nodes = (PlainNode("n", 0.0, -0.0, 1.5, "priority", 8.0), PlainNode("m", 5.0, 1.0))
    texts = PlainNetwork(nodes, (edge,), (PlainCrossing("m", ('a"b',)),), (('a"b',),)).texts()
    roots = {option: ElementTree.fromstring(text) for option, text in texts.items()}
    first, second = roots["--node-files"]
    assert first.attrib == {"id": "n", "x": "0.00", "y": "0.00", "type": "priority", "z": "1.50", "radius": "8.00"}
    assert "z" not in second.attrib
    written, ring = roots["--edge-files"]
    assert written.attrib["id"] == 'a"b'
    assert written.attrib["shape"] == "0.00,0.00 5.00,1.00,2.50"
    assert written.attrib["sidewalkWidth"] == "2.00"
    assert ring.attrib == {"nodes": "n", "edges": 'a"b'}
    (crossing,) = roots["--connection-files"]
    assert crossing.attrib["edges"] == 'a"b'
