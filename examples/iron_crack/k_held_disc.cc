// plain MD: semi-infinite crack, boundary moved by the anisotropic field of K.
#include "md/crystal.h"
#include "md/analytic.h"
#include "md/table_file.h"
#include "md/atom_force.h"
#include "md/crystal_packing.h"
#include "packings/specimen_shape.h"
#include <Eigen/Dense>
#include <complex>
#include <cstdio>
#include <cmath>
#include <cstdlib>
using namespace ligament; using namespace ligament::md; typedef std::complex<double> cd;
int main(int c,char**v){
  std::string sp=v[1]; double L=atof(v[2])*1e-9,K0=atof(v[3])*1e6,K1=atof(v[4])*1e6,T=atof(v[5])*1e-12,frac=0.2;
  bool fcc=sp=="Cu";
  CrystalParameters<3> cp;cp.kind=fcc?CrystalKind::fcc:CrystalKind::bcc;
  if(fcc)cp.orientation=orientation_of({1,1,-2},{1,1,1});
  auto pot= sp=="FeM"?read_setfl_fs("/usr/share/lammps/potentials/Fe_mm.eam.fs",{"Fe"}):sp=="FeA"?read_setfl_fs("/usr/share/lammps/potentials/AlFe_mm.eam.fs",{"Fe"}):sp=="FeP"?read_setfl_fs("/usr/share/lammps/potentials/FeP_mm.eam.fs",{"Fe"}):sp=="FeV"?read_setfl_fs("/usr/share/lammps/potentials/VFe_mm.eam.fs",{"Fe"}):zhou_johnson_wadley({sp});
  Crystal<3> x(pot,cp);
  Eigen::Matrix<double,6,6> S=x.elastic_constants().stiffness.inverse();
  auto b=[&](int i,int j){return S(i,j)-S(i,2)*S(j,2)/S(2,2);};
  double a11=b(0,0),a22=b(1,1),a12=b(0,1),a66=b(5,5),a16=b(0,5),a26=b(1,5);
  Eigen::Matrix4d M=Eigen::Matrix4d::Zero();M(0,3)=-a22/a11;M(1,0)=1;M(1,3)=2*a26/a11;M(2,1)=1;M(2,3)=-(2*a12+a66)/a11;M(3,2)=1;M(3,3)=2*a16/a11;
  auto ev=M.eigenvalues();cd m[2];int q=0;for(int i=0;i<4;i++)if(ev[i].imag()>0&&q<2)m[q++]=ev[i];
  double E=-2/(a22*((m[0]+m[1])/(m[0]*m[1])).imag()); double KG=std::sqrt(2*x.surface_energy(fcc?Vector<3>(1,1,1):Vector<3>(0,1,0))*E);
  cd P[2],Q[2];for(int j=0;j<2;j++){P[j]=a11*m[j]*m[j]+a12-a16*m[j];Q[j]=a12*m[j]+a22/m[j]-a26;}
  auto field=[&](double X,double Y,double&ux,double&uy){ // per K
    double r=std::hypot(X,Y),t=std::atan2(Y,X);cd s1=std::sqrt(std::cos(t)+m[0]*std::sin(t)),s2=std::sqrt(std::cos(t)+m[1]*std::sin(t));
    
    double f=std::sqrt(2*r/M_PI);
    ux=f*((m[0]*P[1]*s2-m[1]*P[0]*s1)/(m[0]-m[1])).real();uy=f*((m[0]*Q[1]*s2-m[1]*Q[0]*s1)/(m[0]-m[1])).real();};
  double per=fcc?x.spacing():x.lattice_parameter(); double tz=std::ceil(2.05*x.potential().cutoff()/per)*per;
  CrystalShape<3> s;s.lower={-L/2,-L/2,-tz/2};s.upper={L/2,L/2,tz/2};s.periodic={false,false,true};
  s.anchor=(fcc?0.25:0.5)*x.basis()*Vector<3>::Ones();
  auto pk=cut_crystal<3>(x,s);
  packings::CrackPoints<3> pts={{-1e-7,0,-1e-8},{0,0,-1e-8},{0,0,1e-8},{-1e-7,0,1e-8}};
  pk.cuts.push_back(packings::CrackPlane<3>(pts,1e-6*x.spacing()));
  auto A=make_atoms<3>(x,pk);
  AtomForce<3> F(x,pk);
  double dt=frac*F.stable_step(A);
  int n=A.size(); double mass=A.mass[0];
  std::printf("%s n=%d tz=%g nm dt=%g fs K_G=%g\n",v[1],n,tz*1e9,dt*1e15,KG/1e6);std::fflush(stdout);
  std::vector<double> fx(n),fy(n);std::vector<char> held(n);
  for(int i=0;i<n;i++){auto r=get(A.reference,i);field(r[0],r[1],fx[i],fy[i]);held[i]=std::max(std::abs(r[0]),std::abs(r[1]))>L/2-1.2e-9;
    A.displacement[0][i]=K0*fx[i];A.displacement[1][i]=K0*fy[i];}
  long steps=std::lround(T/dt);size_t nb=0;double damp=std::exp(-dt/0.3e-12);
  for(long k=0;k<steps;k++){
    double K=K0+(K1-K0)*k/steps;
    F.compute(A,k*dt);
    for(int i=0;i<n;i++){
      if(held[i]){A.displacement[0][i]=K*fx[i];A.displacement[1][i]=K*fy[i];A.velocity[2][i]=0;continue;}
      for(int q=0;q<3;q++){A.velocity[q][i]=damp*A.velocity[q][i]+dt/mass*A.force[q][i];A.displacement[q][i]+=dt*A.velocity[q][i];}
    }
    auto&b=F.broken_bonds();
    if(k%(steps/25)==0||b.size()>nb+100){double lo=0,hi=0,up=0,dn=0;int first=0;for(auto&q:b){lo=std::min(lo,q.position[0]);hi=std::max(hi,q.position[0]);up=std::max(up,q.position[1]);dn=std::min(dn,q.position[1]);}
      std::printf("t=%.2f K=%.4f K/KG=%.3f parted %zu x %.2f..%.2f y %.2f..%.2f nm\n",k*dt*1e12,K/1e6,K/KG,b.size(),lo*1e9,hi*1e9,dn*1e9,up*1e9);std::fflush(stdout);nb=b.size();
      if(b.size()>1500)break;}
  }

  auto co=F.coordination(A);Components<6> st;for(auto&q:st)q.resize(n);F.stresses(A,st);
  double ymin=1;for(int i=0;i<n;i++)if(A.reference[1][i]>0)ymin=std::min(ymin,A.reference[1][i]);
  std::printf("first row y=%.4f nm\n",ymin*1e9);
  for(int i=0;i<n;i++)if(std::abs(A.reference[2][i]+tz/2)<0.16e-9&&std::abs(std::abs(A.reference[1][i])-ymin)<0.02e-9&&std::abs(A.reference[0][i])<4e-9)
    std::printf("x=%.3f y=%.3f z=%.3f ux=%.4f uy=%.4f A coord %d syy %.3g GPa sxx %.3g  field uy %.4f\n",A.reference[0][i]*1e9,A.reference[1][i]*1e9,A.reference[2][i]*1e9,A.displacement[0][i]*1e10,A.displacement[1][i]*1e10,co[i],st[1][i]/1e9,st[0][i]/1e9,K1*fy[i]*1e10);
}
