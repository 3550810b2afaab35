"""Slurm on one machine: controller, node and, if wanted, accounting, as the user who starts it, with all files in one folder."""
import os
import pathlib
import pwd
import secrets
import socket
import subprocess
import time

PROGRAMS = {"slurmctld": "slurm-wlm", "slurmd": "slurm-wlm", "sbatch": "slurm-wlm", "munged": "munge"}
ACCOUNTING_PROGRAMS = {"slurmdbd": "slurmdbd", "sacct": "slurm-wlm", "mariadbd": "mariadb-server", "mariadb": "mariadb-server"}

CONFIG = """
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={node}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.sock
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ReturnToService=2
RequeueExit=143
SchedulerParameters=batch_sched_delay=0,sched_interval=1,sched_min_interval=0,bf_interval=1
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 RealMemory=4000 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""
ACCOUNTING = """
JobAcctGatherType=jobacct_gather/linux
JobAcctGatherFrequency=task=1
AccountingStorageType=accounting_storage/slurmdbd
AccountingStorageHost=127.0.0.1
AccountingStoragePort={database}
AccountingStoragePass={folder}/munge.sock
"""
DATABASE = """
AuthType=auth/munge
AuthInfo=socket={folder}/munge.sock
DbdHost=localhost
DbdPort={database}
SlurmUser={user}
StorageType=accounting_storage/mysql
StorageHost=localhost
StorageUser={user}
StorageLoc=slurm
PidFile={folder}/slurmdbd.pid
LogFile={folder}/slurmdbd.log
"""


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def until(what, tells):
    """Asks again until `tells()` is true: these programs report nothing by themselves."""
    last = time.monotonic() + 60
    while not tells():
        assert time.monotonic() < last, f"{what}: not within a minute"
        time.sleep(0.05)


class Cluster:
    def __init__(self, folder, environment, has_accounting):
        self.folder = pathlib.Path(folder)
        self.environment = {**environment, "PATH": environment["PATH"] + ":/usr/sbin", "SLURM_CONF": str(self.folder / "slurm.conf"),
                            "MYSQL_UNIX_PORT": str(self.folder / "db.sock")}
        self.has_accounting = has_accounting
        self.daemons = []
        self.values = {"folder": self.folder, "user": pwd.getpwuid(os.geteuid()).pw_name, "host": socket.gethostname().split(".")[0],
                       "controller": free_port(), "node": free_port(), "database": free_port()}

    def __enter__(self):
        try:
            self.start()
        except BaseException:
            self.stop()
            raise
        return self

    def __exit__(self, error, *_):
        self.stop()
        if error:
            print((self.folder / "slurmctld.log").read_text())

    def start(self):
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        key = self.folder / "munge.key"
        key.touch(0o600)
        key.write_bytes(secrets.token_bytes(1024))
        at = self.folder
        self.daemon("munged", "--foreground", f"--key-file={key}", f"--socket={at}/munge.sock", f"--pid-file={at}/munged.pid",
                    f"--log-file={at}/munged.log", f"--seed-file={at}/munge.seed")
        until("munge", (at / "munge.sock").exists)
        config = CONFIG + (ACCOUNTING if self.has_accounting else "")
        (at / "slurm.conf").write_text(config.format(**self.values))
        if self.has_accounting:
            self.start_accounting()
        self.daemon("slurmctld", "-D", "-c")
        self.daemon("slurmd", "-D", "-N", self.values["host"])
        until("node", lambda: "idle" in self.ask("sinfo", "-h", "-o", "%T"))

    def start_accounting(self):
        at = self.folder
        self.tell("mariadb-install-db", "--no-defaults", f"--datadir={at}/db", "--auth-root-authentication-method=normal")
        self.daemon("mariadbd", "--no-defaults", "--skip-networking", f"--datadir={at}/db", f"--socket={at}/db.sock",
                    "--innodb-buffer-pool-size=64M")
        sql = "create database slurm; create user {user}@localhost; grant all on slurm.* to {user}@localhost".format(**self.values)
        root = ["mariadb", "--no-defaults", f"--socket={at}/db.sock", "--user=root", "--execute"]
        until("database", lambda: self.ask(*root, "select 'up'").startswith("up"))
        self.tell(*root, sql)
        settings = at / "slurmdbd.conf"
        settings.touch(0o600)
        settings.write_text(DATABASE.format(**self.values))
        self.daemon("slurmdbd", "-D")
        until("accounting", lambda: "Cluster" in self.ask("sacctmgr", "list", "cluster"))
        self.tell("sacctmgr", "-i", "add", "cluster", "test")

    def daemon(self, *words):
        with open(self.folder / f"{words[0]}.out", "w") as out:
            self.daemons.append(subprocess.Popen(words, env=self.environment, cwd=self.folder, stdin=subprocess.DEVNULL, stdout=out,
                                                 stderr=subprocess.STDOUT))

    def ask(self, *words):
        """What it prints, errors too."""
        return subprocess.run(words, env=self.environment, cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True).stdout

    def tell(self, *words, folder=None):
        done = subprocess.run(words, env=self.environment, cwd=folder or self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True)
        assert done.returncode == 0, f"{words}: {done.stdout}"
        return done.stdout

    def stop(self):
        """Last started, first ended: the controller ends what still runs."""
        for process in reversed(self.daemons):
            process.terminate()
            process.wait()
