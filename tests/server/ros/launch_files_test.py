#!/usr/bin/env python3
"""What launch files promise, by roslaunch's own reading of them.
launch_files_test.py FOLDER: in a shell that has the devel space (ROS_PACKAGE_PATH)."""
import os
import pathlib
import shlex
import sys
import unittest
import unittest.mock

import roslaunch.config
import roslaunch.core
import roslaunch.xmlloader

FOLDER = pathlib.Path(sys.argv.pop())


def load(name, **arguments):
    config = roslaunch.config.ROSLaunchConfig()
    given = [f"{argument}:={value}" for argument, value in arguments.items()]
    roslaunch.xmlloader.XmlLoader().load(str(FOLDER / name), config, argv=given, verbose=False)
    return config


def load_within(namespace, name):
    config = roslaunch.config.ROSLaunchConfig()
    text = f'<launch><group ns="{namespace}"><include file="{FOLDER / name}" /></group></launch>'
    roslaunch.xmlloader.XmlLoader().load_string(text, config, verbose=False)
    return config


class LaunchFiles(unittest.TestCase):
    def test_explain_every_argument(self):
        files = sorted(FOLDER.glob("*.launch"))
        self.assertGreaterEqual(len(files), 7)
        for file in files:
            for line in file.read_text().splitlines():
                if line.strip().startswith("<arg name=") and "value=" not in line:
                    self.assertIn(" doc=", line, file.name)

    def test_take_no_launch_file_down_that_includes_them(self):
        for rviz in ("true", "false"):
            for node in load("xsens_client.launch", launch_rviz=rviz).nodes:
                self.assertFalse(node.required, node.name)
        for name, arguments in (("rviz.launch", {}), ("rviz.launch", {"rviz_config_file": "/a.rviz"}), ("record.launch", {"bag": "/a"})):
            for node in load(name, **arguments).nodes:
                self.assertFalse(node.required, name)

    def test_joint_angles_as_streamed_are_an_argument(self):
        for name, node in (("xsens_client.launch", "xsens"), ("kinescope.launch", "kinescope"), ("bridge.launch", "kinescope")):
            parameter = f"/{node}/joint_angle_source"
            self.assertEqual(load(name).params[parameter].value, "computed", name)
            streamed = load(name, joint_angle_source="streamed")
            self.assertEqual(streamed.params[parameter].value, "streamed", name)

    def test_rviz_has_a_configuration_of_the_node_or_that_which_is_named(self):
        for name, arguments in (("xsens_client.launch", {}), ("kinescope.launch", {"rviz": "true"}), ("rviz.launch", {})):
            made = [node for node in load(name, **arguments).nodes if node.name == "rviz"]
            self.assertEqual([(node.package, node.args.split()[:2]) for node in made], [("kinescope", ["rviz", "--start"])], name)
            named = [node for node in load(name, rviz_config_file="/of me/a.rviz", **arguments).nodes if node.name == "rviz"]
            self.assertEqual([node.package for node in named], ["rviz"], name)
            self.assertEqual(shlex.split(named[0].args)[:2], ["-d", "/of me/a.rviz"])

    def test_names_of_nodes_may_begin_with_a_slash(self):
        for node, pattern in (("lab", "/(.*/)?lab"), ("/lab/", "/lab"), ("ns/lab", "/(.*/)?ns/lab")):
            record = load("record.launch", bag="/data/trial", node=node).nodes[0]
            self.assertIn(f'-e "{pattern}/(.*/)?(', record.args)
            rviz = load("rviz.launch", node=node).nodes[0]
            self.assertEqual(rviz.args.split()[-2:], ["--node", node.rstrip("/")])

        for given, wanted in (("/lab", "/lab"), ("ns/lab", "/ns/lab"), ("", "/kinescope")):
            bridge = load("bridge.launch", node=given).nodes[0]
            self.assertEqual((bridge.namespace + "/" + bridge.name).replace("//", "/"), wanted)

    def test_stay_in_the_namespace_that_includes_them(self):
        for name, node in (("xsens_client.launch", "xsens"), ("kinescope.launch", "kinescope"), ("bridge.launch", "kinescope")):
            launch = load_within("lab", name)
            self.assertIn("/lab/", [node.namespace for node in launch.nodes], name)
            self.assertIn(f"/lab/{node}/reference_frame", launch.params, name)
            for started in launch.nodes:
                self.assertNotIn("/" + node, started.args.split(), name)

    def test_paths_are_those_of_the_shell(self):
        with unittest.mock.patch.dict(os.environ, PWD="/here", HOME="/me"):
            for given, wanted in (("/a/b", "/a/b"), ("b", "/here/b"), ("~/b", "/me/b"), ("my b", "/here/my b")):
                arguments = shlex.split(load("record.launch", bag=given).nodes[0].args)
                self.assertEqual(arguments[arguments.index("-o") + 1], wanted)
                for name, node in (("kinescope.launch", "kinescope"), ("monitor.launch", "kinescope_monitor")):
                    self.assertEqual(load(name, token_file=given).params[f"/{node}/token_file"].value, wanted)
            self.assertEqual(load("kinescope.launch").params["/kinescope/token_file"].value, "")
            for given, wanted in (("a.bag", "/here/a.bag"), ("~/a.bag", "/me/a.bag"), ("/a.bag", "/a.bag"), ("udp://:9763", "udp://:9763")):
                for name in ("kinescope.launch", "bridge.launch"):
                    self.assertEqual(load(name, source=given).params["/kinescope/source"].value, wanted)

    def test_refuse_what_is_neither_true_nor_false(self):
        for name, argument in (("kinescope.launch", "rviz"), ("demo.launch", "rviz"), ("xsens_client.launch", "launch_rviz")):
            with self.assertRaisesRegex((ValueError, roslaunch.core.RLException), "maybe"):
                load(name, **{argument: "maybe"})


if __name__ == "__main__":
    unittest.main()
