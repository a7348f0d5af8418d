"""The ROS graph in words and in Mermaid's language."""

import re
from xml.etree import ElementTree

import nbformat
from hypothesis import given
from hypothesis import strategies as st
from lab_fakes import NAVIGATE, POSE, SCAN, STATUS, TWIST, GraphNode
from nbconvert import HTMLExporter

from turtle_lesson.lab.graph import plot_graph

SVG = "{http://www.w3.org/2000/svg}"
PARAMETERS = "rcl_interfaces/srv/GetParameters"


def lesson() -> GraphNode:
    return GraphNode(
        {
            "/turtlesim": {
                "pub": {"/turtle1/pose": POSE, "/rosout": "rcl_interfaces/msg/Log"},
                "sub": {"/turtle1/cmd_vel": TWIST},
                "srv": {
                    "/kill": "turtlesim/srv/Kill",
                    "/turtlesim/get_parameters": PARAMETERS,
                    "/clear": "std_srvs/srv/Empty",
                },
            },
            "/navigator": {
                "pub": {"/turtle1/cmd_vel": TWIST},
                "sub": {"/turtle1/pose": POSE},
                "srv": {"/navigate_to": NAVIGATE},
            },
            "/client": {"cli": {"/navigate_to": NAVIGATE, "/navigator/_action/hidden": NAVIGATE}},
            "/_lab": {"sub": {"/turtle1/pose": POSE, "/obstacles": SCAN, "/robot/status": STATUS}},
        }
    )


def test_the_graph_in_words():
    assert repr(plot_graph(lesson())) == (
        "The ROS graph has 3 nodes, 2 topics and 3 services. /client calls /navigate_to. "
        "/navigator publishes /turtle1/cmd_vel; hears /turtle1/pose; offers /navigate_to. "
        "/turtlesim publishes /turtle1/pose; hears /turtle1/cmd_vel; offers /clear and /kill. "
        "Types: /turtle1/cmd_vel geometry_msgs/msg/Twist, /turtle1/pose turtlesim/msg/Pose, "
        "/clear std_srvs/srv/Empty, /kill turtlesim/srv/Kill, /navigate_to robot_controller/srv/NavigateTo."
    )


def test_the_graph_in_mermaid():
    drawn = plot_graph(lesson()).mermaid.splitlines()
    assert drawn[1:3] == ["flowchart TD", "accTitle: ROS graph: 3 nodes, 2 topics and 3 services"]
    assert drawn[4:-3] == [
        'n0(["/client"]):::rosnode',
        'n1(["/navigator"]):::rosnode',
        'n2(["/turtlesim"]):::rosnode',
        't0["/turtle1/cmd_vel<br/><small>geometry_msgs/msg/Twist</small>"]:::rostopic',
        't1["/turtle1/pose<br/><small>turtlesim/msg/Pose</small>"]:::rostopic',
        "n1 --> t0",
        "t1 --> n1",
        "n2 --> t1",
        "t0 --> n2",
        's2[["/navigate_to<br/><small>robot_controller/srv/NavigateTo</small>"]]:::rosservice',
        "n0 -.-> s2",
        "s2 -.-> n1",
        'w2[["/clear<br/>/kill"]]:::rosservice',
        "w2 -.-> n2",
    ]


def test_front_ends_get_what_they_can_draw():
    picture = plot_graph(lesson())
    bundle = picture._repr_mimebundle_()
    assert list(bundle) == ["text/html", "text/vnd.mermaid", "text/plain"]
    assert bundle["text/html"].startswith(f'<img alt="{picture.text}" src="data:image/svg+xml;base64,')
    assert (bundle["text/vnd.mermaid"], bundle["text/plain"]) == (picture.mermaid, picture.text)


def boxes(drawing: str) -> list[tuple[float, float, float, float]]:
    """Left, top, right and bottom of each box."""
    rects = ElementTree.fromstring(drawing).findall(f"{SVG}rect")
    found = [[float(rect.attrib[name]) for name in ("x", "y", "width", "height")] for rect in rects]
    return [(x, y, x + width, y + height) for x, y, width, height in found]


def test_the_drawing_names_everything_and_speaks():
    picture = plot_graph(lesson())
    root = ElementTree.fromstring(picture.svg)
    assert root.findtext(f"{SVG}desc") == picture.text
    assert root.findtext(f"{SVG}title") == "ROS graph: 3 nodes, 2 topics and 3 services"
    words = {each.text for each in root.iter(f"{SVG}text")}
    assert {"services", "nodes", "topics", "/turtlesim", "/turtle1/pose", POSE, "/navigate_to", "/clear"} <= words
    assert len(boxes(picture.svg)) == 3 + 2 + 2


def test_a_page_shows_it_without_a_kernel_and_without_a_network():
    picture = plot_graph(lesson())
    bundle = picture._repr_mimebundle_()
    page = nbformat.v4.new_notebook()
    page.cells = [nbformat.v4.new_code_cell("graph", outputs=[nbformat.v4.new_output("display_data", bundle)])]
    shown, _ = HTMLExporter().from_notebook_node(page)
    assert f'<img alt="{picture.text}" src="data:image/svg+xml;base64,' in shown
    assert "flowchart TD" not in shown


@given(st.deferred(lambda: nodes_of))
def test_no_box_lies_upon_another_or_beyond_the_edge(nodes):
    drawing = plot_graph(GraphNode(nodes)).svg
    if not drawing:
        return
    _, _, width, height = map(float, ElementTree.fromstring(drawing).attrib["viewBox"].split())
    placed = boxes(drawing)
    for at, (left, top, right, bottom) in enumerate(placed):
        assert 0 <= left < right <= width and 0 <= top < bottom <= height
        for other in placed[:at]:
            assert right < other[0] or left > other[2] or bottom < other[1] or top > other[3]


def test_hidden_names_are_left_out():
    drawn = plot_graph(lesson()).mermaid
    assert all(name not in drawn for name in ("_lab", "hidden", "rosout", "get_parameters", "/obstacles"))


def test_two_nodes_of_one_name_are_counted():
    text = plot_graph(GraphNode({"/twin": {"pub": {"/a": POSE}}}, twins=("/twin",))).text
    assert text.startswith("The ROS graph has 2 nodes, 1 topic and no service. /twin (2 nodes of this name)")


def test_a_node_without_anything():
    assert "/lonely uses no topic and no service." in plot_graph(GraphNode({"/lonely": {}})).text


def test_an_empty_graph_says_what_to_start():
    picture = plot_graph(GraphNode({"/_lab": {}}))
    assert picture.text.startswith("No node is running. Start some: ros2 run turtlesim turtlesim_node")
    assert picture._repr_mimebundle_() == {"text/plain": picture.text}


plain = st.from_regex(r"[A-Za-z][A-Za-z0-9_]{0,9}", fullmatch=True)
tricky = st.sampled_from(["end", "graph", "class", "o", "x__y", "A_", "n0", "t0", "default"])
names = st.lists(plain | tricky, min_size=1, max_size=3).map(lambda parts: "/" + "/".join(parts))
ends = st.dictionaries(names, st.just(POSE), max_size=3)
nodes_of = st.dictionaries(names, st.fixed_dictionaries(dict.fromkeys(("pub", "sub", "srv", "cli"), ends)), max_size=4)


@given(nodes_of)
def test_any_legal_names_give_lines_that_mermaid_can_read(nodes):
    picture = plot_graph(GraphNode(nodes))
    assert picture.text == plot_graph(GraphNode(dict(reversed(nodes.items())))).text
    label = r'"([A-Za-z0-9/ _]|#\d+;|<br/>|</?small>)+"'
    shapes = rf"[nstw]\d+(\(\[{label}\]\)|\[\[{label}\]\]|\[{label}\]):::ros(node|topic|service)"
    for line in picture.mermaid.splitlines()[4:-3]:
        assert re.fullmatch(rf"{shapes}|[nstw]\d+ -(\.-|-)> [nstw]\d+", line), line
